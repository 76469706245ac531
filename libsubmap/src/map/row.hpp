// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "database.hpp"
#include "digest.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/pose.hpp"

namespace hmt::submap {

/// Binds the fields of one record to the parameters of a statement, in order, and adds each to a
/// checksum. A pose takes seven parameters (x y z qx qy qz qw), a position three, a
/// matrix one blob of doubles.
class RowWriter {
 public:
  RowWriter(Statement& statement, Digest& digest) : statement_(&statement), digest_(&digest) {}

  template <class... Fields>
  void operator()(const Fields&... fields) {
    (put(fields), ...);
  }

 private:
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void put(T field) {
    const auto value = static_cast<int64_t>(field);
    digest_->add(value);
    statement_->bind(++column_, value);
  }
  void put(double value) {
    digest_->add(value);
    statement_->bind(++column_, value);
  }
  void put(const std::string& text) {
    digest_->add(std::string_view(text));
    statement_->bind_text(++column_, text);
  }
  void put(const graph::Pose& pose) {
    for (int k = 0; k < 3; ++k) put(pose.translation[k]);
    for (int k = 0; k < 4; ++k) put(pose.rotation.coeffs()[k]);
  }
  void put(const Eigen::Vector3d& vector) {
    for (int k = 0; k < 3; ++k) put(vector[k]);
  }
  template <int kSize>
  void put(const Eigen::Matrix<double, kSize, kSize>& matrix) {
    const std::string_view bytes(reinterpret_cast<const char*>(matrix.data()),
                                 sizeof(double) * kSize * kSize);
    digest_->add(bytes);
    statement_->bind_blob(++column_, bytes);
  }

  Statement* statement_;
  Digest* digest_;
  int column_ = 0;
};

/// Takes the fields of one record from the columns of the current row, in the same order.
class RowReader {
 public:
  RowReader(const Statement& statement, Digest& digest)
      : statement_(&statement), digest_(&digest) {}

  template <class... Fields>
  void operator()(Fields&... fields) {
    (get(fields), ...);
  }

 private:
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void get(T& field) {
    const int64_t value = statement_->integer(column_++);
    if constexpr (sizeof(T) < sizeof(int64_t))
      if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
        statement_->database().fail_damaged("a number is out of range");
    digest_->add(value);
    field = static_cast<T>(value);
  }
  void get(double& value) {
    value = statement_->real(column_++);
    digest_->add(value);
  }
  void get(std::string& text) {
    text = statement_->text(column_++);
    digest_->add(std::string_view(text));
  }
  void get(graph::Pose& pose) {
    for (int k = 0; k < 3; ++k) get(pose.translation[k]);
    for (int k = 0; k < 4; ++k) get(pose.rotation.coeffs()[k]);
  }
  void get(Eigen::Vector3d& vector) {
    for (int k = 0; k < 3; ++k) get(vector[k]);
  }
  template <int kSize>
  void get(Eigen::Matrix<double, kSize, kSize>& matrix) {
    const std::string_view bytes = statement_->blob(column_++);
    if (bytes.size() != sizeof(double) * kSize * kSize)
      statement_->database().fail_damaged("a matrix has the wrong size");
    digest_->add(bytes);
    std::memcpy(matrix.data(), bytes.data(), bytes.size());
  }

  const Statement* statement_;
  Digest* digest_;
  int column_ = 0;
};

}  // namespace hmt::submap
