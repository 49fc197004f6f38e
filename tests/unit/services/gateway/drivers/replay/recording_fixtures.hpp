#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace limbcast::gateway::test {

using test_support::TemporaryFolder;

void WriteText(const std::filesystem::path& path, std::string_view text);

/// One dataset of a made-up HDF5 file.
struct FixtureDataset {
  std::string name;  ///< "/imu_gyr" or "/pelvis/imu_acc": groups are made on the way
  std::size_t rows = 0;
  std::size_t columns = 0;  ///< 0: rank 1
  std::function<double(std::size_t row, std::size_t column)> value;
};

/// Writes a file with these datasets of float64 and, unless 0, the attribute sampling_rate.
void WriteHdf5(const std::filesystem::path& path, const std::vector<FixtureDataset>& datasets,
               double sampling_rate_hz);

/// A BROAD trial of `rows` rows at 250 Hz: gyro (row, 0, 0), accel (0, 0, 9.81), mag (20, 0, -row/2
/// without remainder) µT so that every second reading is held, truth the identity but NaN in row 2,
/// movement from row 3 on.
std::vector<FixtureDataset> BroadDatasets(std::size_t rows);

/// A full-body recording at 100 Hz of the sensors pelvis, lower_back, right_forearm and gadget.
std::vector<FixtureDataset> FullBodyDatasets(std::size_t rows);

}  // namespace limbcast::gateway::test
