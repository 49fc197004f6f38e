#include "tests/unit/services/gateway/drivers/replay/recording_fixtures.hpp"

#include <hdf5.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "common/base/expects.hpp"

namespace limbcast::gateway::test {

void WriteText(const std::filesystem::path& path, std::string_view text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  Expects(file.good(), "a written fixture");
}

void WriteHdf5(const std::filesystem::path& path, const std::vector<FixtureDataset>& datasets,
               double sampling_rate_hz) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  Expects(file >= 0, "a created HDF5 file");
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  for (const FixtureDataset& dataset : datasets) {
    const std::size_t columns = dataset.columns == 0 ? 1 : dataset.columns;
    std::vector<double> values;
    for (std::size_t row = 0; row < dataset.rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        values.push_back(dataset.value(row, column));
      }
    }
    const std::array<hsize_t, 2> shape{dataset.rows, columns};
    const hid_t space = H5Screate_simple(dataset.columns == 0 ? 1 : 2, shape.data(), nullptr);
    const hid_t set = H5Dcreate2(file, dataset.name.c_str(), H5T_NATIVE_DOUBLE, space, links,
                                 H5P_DEFAULT, H5P_DEFAULT);
    Expects(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
            "a written dataset");
    H5Dclose(set);
    H5Sclose(space);
  }
  if (sampling_rate_hz != 0.0) {
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute =
        H5Acreate2(file, "sampling_rate", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_DOUBLE, &sampling_rate_hz);
    H5Aclose(attribute);
    H5Sclose(space);
  }
  H5Pclose(links);
  H5Fclose(file);
}

std::vector<FixtureDataset> BroadDatasets(std::size_t rows) {
  return {
      {"/imu_gyr", rows, 3,
       [](std::size_t row, std::size_t column) {
         return column == 0 ? static_cast<double>(row) : 0.0;
       }},
      {"/imu_acc", rows, 3,
       [](std::size_t, std::size_t column) { return column == 2 ? 9.81 : 0.0; }},
      {"/imu_mag", rows, 3,
       [](std::size_t row, std::size_t column) {
         return std::array<double, 3>{20.0, 0.0, -static_cast<double>(row / 2)}[column];
       }},
      {"/opt_quat", rows, 4,
       [](std::size_t row, std::size_t column) {
         return row == 2 ? std::nan("") : (column == 0 ? -1.0 : 0.0);
       }},
      {"/opt_pos", rows, 3,
       [](std::size_t, std::size_t column) { return column == 2 ? 1.5 : 0.0; }},
      {"/movement", rows, 0, [](std::size_t row, std::size_t) { return row >= 3 ? 1.0 : 0.0; }},
  };
}

std::vector<FixtureDataset> FullBodyDatasets(std::size_t rows) {
  std::vector<FixtureDataset> datasets = {{"/time", rows, 0, [](std::size_t row, std::size_t) {
                                             return static_cast<double>(row) / 100.0;
                                           }}};
  for (const std::string group : {"pelvis", "lower_back", "right_forearm", "gadget"}) {
    datasets.push_back({"/" + group + "/imu_acc", rows, 3,
                        [](std::size_t, std::size_t column) { return column == 0 ? 9.81 : 0.0; }});
    datasets.push_back({"/" + group + "/imu_gyr", rows, 3,
                        [](std::size_t row, std::size_t) { return static_cast<double>(row); }});
  }
  return datasets;
}

}  // namespace limbcast::gateway::test
