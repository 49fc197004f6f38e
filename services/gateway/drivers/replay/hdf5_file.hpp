#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::gateway {

/// A table of numbers as read from a file, row by row.
struct NumberTable {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * columns + column];
  }
};

/// An HDF5 file opened for reading. Every refusal of the library becomes one Error that names the
/// file, the dataset and the reason; nothing is printed. Thread-compatible; two files at a time
/// only from one thread (the library of the distribution is not built for more).
class Hdf5File {
 public:
  [[nodiscard]] static Result<Hdf5File> Open(const std::filesystem::path& path);
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  ~Hdf5File();

  /// True when there is a dataset or group of this name ("/imu_gyr", "/pelvis/imu_acc").
  [[nodiscard]] bool Has(const std::string& name) const;

  /// Names of the groups directly under the root, in the order of the alphabet.
  [[nodiscard]] std::vector<std::string> Groups() const;

  /// A dataset of shape N × columns (or N, for columns = 1) of any number type. kNotFound: no such
  /// dataset; kCorruptData: other shape or type, or bytes that cannot be read.
  [[nodiscard]] Result<NumberTable> ReadTable(const std::string& name, std::size_t columns) const;

  /// A scalar attribute of the root.
  [[nodiscard]] Result<double> ReadNumberAttribute(const std::string& name) const;

  /// The root's attribute sampling_rate. Range: (0, 100000].
  [[nodiscard]] Result<double> ReadSamplingRate_hz() const;

  /// An Error that begins with the file's path.
  [[nodiscard]] Error MakeError(ErrorCode code, const std::string& what) const;

 private:
  Hdf5File(std::filesystem::path path, std::int64_t file) : path_(std::move(path)), file_(file) {}

  std::filesystem::path path_;
  std::int64_t file_ = -1;  // hid_t
};

}  // namespace limbcast::gateway
