// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns of an overlap inside Boost's gzip_compressor that is not there (GCC bug 105651).
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include "hmt/submap/export/carmen_file.hpp"

#include <boost/iostreams/categories.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <string>

#include "hmt/graph/input_error.hpp"
#include "hmt/submap/export/atomic_file.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

namespace io = boost::iostreams;

constexpr int kRangeDecimals = 2;
constexpr int kPoseDecimals = 6;

/// Hands compressed bytes on. Streams swallow exceptions when they close, so the first error is
/// kept beside them.
struct Sink {
  using char_type = char;
  using category = io::sink_tag;

  std::streamsize write(const char* bytes, std::streamsize size) {
    try {
      if (error->empty()) file->write({bytes, static_cast<size_t>(size)});
    } catch (const graph::InputError& failure) {
      *error = failure.what();
    }
    return size;
  }

  AtomicFile* file;
  std::string* error;
};

void append_pose(std::string& line, const graph::Pose& T) {
  append_number(line, T.translation.x(), kPoseDecimals);
  append_number(line, T.translation.y(), kPoseDecimals);
  append_number(line, T.yaw_rad(), kPoseDecimals);
}

/// Ends a line: stamp, host, stamp of the logger.
void append_stamps(std::string& line, double stamp_s) {
  line.append(" ");
  append_stamp(line, stamp_s);
  line.append(" host ");
  append_stamp(line, stamp_s);
  line.append("\n");
}

}  // namespace

struct CarmenWriter::Stream {
  explicit Stream(const std::filesystem::path& path) : file(path) {
    const auto extension = path.extension();
    if (extension == ".gz") out.push(io::gzip_compressor());
    if (extension == ".bz2") out.push(io::bzip2_compressor());
    if (extension == ".zst") out.push(io::zstd_compressor());
    out.push(Sink{&file, &error});
  }

  void write(const std::string& text) {
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    check();
  }
  void check() const {
    if (!error.empty()) throw graph::InputError(error);
  }

  AtomicFile file;
  std::string error;
  io::filtering_ostream out;
};

CarmenWriter::CarmenWriter(const std::filesystem::path& path)
    : stream_(std::make_unique<Stream>(path)) {
  stream_->write(
      "# message_name [message contents] ipc_timestamp ipc_hostname logger_timestamp\n"
      "# ODOM x y theta tv rv accel\n"
      "# FLASER num_readings [range_readings] x y theta odom_x odom_y odom_theta\n");
}
CarmenWriter::~CarmenWriter() = default;
CarmenWriter::CarmenWriter(CarmenWriter&&) noexcept = default;
CarmenWriter& CarmenWriter::operator=(CarmenWriter&&) noexcept = default;

void CarmenWriter::add(std::span<const double> ranges_m, const graph::Pose& T_odom_laser,
                       const graph::Pose& T_odom_robot, double stamp_s) {
  std::string text;
  text.append("ODOM");
  append_pose(text, T_odom_robot);
  text.append(" 0 0 0");
  append_stamps(text, stamp_s);
  text.append("FLASER ").append(std::to_string(ranges_m.size()));
  for (const double range_m : ranges_m) append_number(text, range_m, kRangeDecimals);
  append_pose(text, T_odom_laser);
  append_pose(text, T_odom_robot);
  append_stamps(text, stamp_s);
  stream_->write(text);
}

void CarmenWriter::commit() {
  stream_->out.reset();
  stream_->check();
  stream_->file.commit();
}

}  // namespace hmt::submap
