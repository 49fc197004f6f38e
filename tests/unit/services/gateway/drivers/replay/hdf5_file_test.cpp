#include "services/gateway/drivers/replay/hdf5_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/services/gateway/drivers/replay/recording_fixtures.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Hdf5FileTest : public ::testing::Test {
 protected:
  std::filesystem::path Write(double rate_hz = 100.0) {
    const std::filesystem::path path = folder_.path() / "a.hdf5";
    test::WriteHdf5(path, test::FullBodyDatasets(5), rate_hz);
    return path;
  }
  test::TemporaryFolder folder_;
};

TEST_F(Hdf5FileTest, FindsDatasetsAndGroups) {
  const Result<Hdf5File> file = Hdf5File::Open(Write());
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->Has("/time"));
  EXPECT_TRUE(file->Has("/pelvis/imu_acc"));
  EXPECT_FALSE(file->Has("/pelvis/imu_mag"));
  EXPECT_FALSE(file->Has("/nobody/imu_acc"));
  EXPECT_THAT(file->Groups(), ElementsAre("gadget", "lower_back", "pelvis", "right_forearm"));
}

TEST_F(Hdf5FileTest, ReadsTablesRowByRow) {
  const Result<Hdf5File> file = Hdf5File::Open(Write());
  const Result<NumberTable> table = file->ReadTable("/pelvis/imu_acc", 3);
  ASSERT_TRUE(table.ok());
  EXPECT_EQ(table->rows, 5U);
  EXPECT_EQ(table->at(4, 0), 9.81);
  EXPECT_EQ(table->at(4, 1), 0.0);
}

TEST_F(Hdf5FileTest, MissingDatasetIsNamed) {
  const Result<Hdf5File> file = Hdf5File::Open(Write());
  const Result<NumberTable> table = file->ReadTable("/pelvis/imu_mag", 3);
  ASSERT_FALSE(table.ok());
  EXPECT_EQ(table.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(table.error().message, HasSubstr("a.hdf5: dataset /pelvis/imu_mag is missing"));
}

TEST_F(Hdf5FileTest, WrongShapeIsNamedWithBothShapes) {
  const Result<Hdf5File> file = Hdf5File::Open(Write());
  const Result<NumberTable> table = file->ReadTable("/pelvis/imu_acc", 4);
  ASSERT_FALSE(table.ok());
  EXPECT_THAT(table.error().message, HasSubstr("must be N x 4, is 5 x 3"));
  EXPECT_THAT(file->ReadTable("/time", 3).error().message, HasSubstr("is of rank 1"));
}

TEST_F(Hdf5FileTest, GroupIsNoDataset) {
  const Result<Hdf5File> file = Hdf5File::Open(Write());
  EXPECT_THAT(file->ReadTable("/pelvis", 3).error().message, HasSubstr("/pelvis is no dataset"));
}

TEST_F(Hdf5FileTest, TruncatedFileIsOneLineThatSaysSo) {
  const std::filesystem::path path = Write();
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Result<Hdf5File> file = Hdf5File::Open(path);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().code, ErrorCode::kCorruptData);
  EXPECT_THAT(file.error().message, HasSubstr("truncated"));
  EXPECT_THAT(file.error().message, ::testing::Not(HasSubstr("\n")));
}

TEST_F(Hdf5FileTest, CutAnywhereNeverCrashes) {
  const std::filesystem::path path = Write();
  const auto size = std::filesystem::file_size(path);
  for (auto keep = size; keep > 0; keep -= std::min<std::uintmax_t>(keep, 97)) {
    std::filesystem::resize_file(path, keep);
    const Result<Hdf5File> file = Hdf5File::Open(path);
    EXPECT_EQ(file.ok(), keep == size) << "with " << keep << " of " << size << " bytes";
  }
}

TEST_F(Hdf5FileTest, SamplingRateHasARange) {
  EXPECT_EQ(*Hdf5File::Open(Write(100.0))->ReadSamplingRate_hz(), 100.0);
  EXPECT_THAT(Hdf5File::Open(Write(-1.0))->ReadSamplingRate_hz().error().message,
              HasSubstr("sampling_rate must be in (0, 100000], is -1"));
  EXPECT_EQ(Hdf5File::Open(Write(0.0))->ReadSamplingRate_hz().error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace limbcast::gateway
