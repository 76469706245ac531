// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "console.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>

namespace hmt::apps {
namespace {

// A signal handler can only reach a global; nothing else uses it.
volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int) {
  interrupted = 1;
}

/// Draws progress: rewrites one line in a terminal, writes a line every five seconds elsewhere.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(bool terminal) : terminal_(terminal) {}
  ~ProgressPrinter() { end_line(); }

  void show(const submap::Progress& p) {
    const auto now = std::chrono::steady_clock::now();
    const bool new_stage = p.stage != stage_;
    const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(5000);
    if (!new_stage && now - last_ < pause) return;
    if (new_stage) end_line();
    stage_ = p.stage;
    last_ = now;
    const std::string text = p.total > 0
                                 ? fmt::format("{}: {:.0f} %", stage_, 100 * p.done / p.total)
                                 : fmt::format("{}: {:.0f}", stage_, p.done);
    std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text.c_str());
    std::fflush(stderr);
    open_line_ = terminal_;
  }

  void end_line() {
    if (open_line_) std::fputs("\r\033[K", stderr);
    open_line_ = false;
  }

 private:
  bool terminal_;
  bool open_line_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace

submap::Run make_run(const Globals& globals) {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  submap::Run run;
  run.threads = globals.threads;
  run.stop = [] { return interrupted != 0; };
  // Shared by the callbacks below, which may outlive this function and each other.
  auto printer = std::make_shared<ProgressPrinter>(globals.progress == ProgressMode::automatic &&
                                                   isatty(STDERR_FILENO));
  if (globals.progress != ProgressMode::none && !globals.quiet)
    run.progress = [printer](const submap::Progress& p) { printer->show(p); };
  run.info = [printer](const std::string& text) {
    printer->end_line();
    spdlog::info(text);
  };
  run.detail = [printer](const std::string& text) {
    printer->end_line();
    spdlog::debug(text);
  };
  run.warn = [printer](const std::string& text) {
    printer->end_line();
    spdlog::warn(text);
  };
  return run;
}

void print_result(const Globals& globals, const nlohmann::ordered_json& object,
                  const std::string& text) {
  const std::string out = globals.json ? object.dump() + "\n" : text;
  std::fwrite(out.data(), 1, out.size(), stdout);
  std::fflush(stdout);
}

}  // namespace hmt::apps
