#include "services/posture/alignment_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"
#include "tests/support/temporary_folder.hpp"

namespace limbcast::posture {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class AlignmentStoreTest : public ::testing::Test {
 protected:
  AlignmentStoreTest() : folder_(temporary_ / "state"), store_(folder_) {
    EXPECT_TRUE(store_.Prepare().ok());
    aligned_ = *body::MakeDefaultBody(kBody, 1.9);
    aligned_.revision = 7;
    for (body::SegmentDefinition& segment : aligned_.segments) {
      segment.sensor_uid = SensorUid{0xFEDCBA9876543210ULL + body::Index(segment.segment)};
      segment.aligned = true;
      segment.q_sensor_segment =
          math::ExpSO3({0.1 * static_cast<double>(body::Index(segment.segment)), -0.7, 1.0 / 3.0});
      segment.heading_correction_rad = -1.0 / 7.0;
      segment.alignment_quality = body::Index(segment.segment) % 2 == 0 ? 1.0F : 0.625F;
      segment.length_measured = body::Index(segment.segment) % 3 == 0;
    }
  }

  std::string Text() const {
    std::ifstream file(store_.PathOf(kBody));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void Overwrite(const std::string& text) const {
    std::ofstream(store_.PathOf(kBody), std::ios::trunc) << text;
  }
  std::string Refusal() const {
    body::BodyDefinition definition = *body::MakeDefaultBody(kBody);
    const auto loaded = store_.Load(definition);
    EXPECT_FALSE(definition.segments[0].aligned) << "unchanged";
    return loaded.ok() ? std::string() : loaded.error().message;
  }

  static constexpr BodyId kBody{3};
  const test_support::TemporaryFolder temporary_;
  const fs::path folder_;  // made by Prepare
  const AlignmentStore store_;
  body::BodyDefinition aligned_;
};

TEST_F(AlignmentStoreTest, WhatIsSavedComesBackToTheLastBit) {
  ASSERT_TRUE(store_.Save(aligned_).ok());
  body::BodyDefinition loaded = *body::MakeDefaultBody(kBody);
  const auto found = store_.Load(loaded);
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_TRUE(*found);
  EXPECT_EQ(loaded.revision, 7U);
  for (std::size_t i = 0; i < loaded.segments.size(); ++i) {
    EXPECT_EQ(loaded.segments[i].sensor_uid, aligned_.segments[i].sensor_uid);
    EXPECT_TRUE(loaded.segments[i].q_sensor_segment.coeffs() ==
                aligned_.segments[i].q_sensor_segment.coeffs());
    EXPECT_EQ(loaded.segments[i].heading_correction_rad,
              aligned_.segments[i].heading_correction_rad);
    EXPECT_TRUE(loaded.segments[i].p_segment_end_m == aligned_.segments[i].p_segment_end_m);
    EXPECT_TRUE(loaded.segments[i].aligned);
    EXPECT_EQ(loaded.segments[i].alignment_quality, aligned_.segments[i].alignment_quality);
    EXPECT_EQ(loaded.segments[i].length_measured, aligned_.segments[i].length_measured);
  }
}

TEST_F(AlignmentStoreTest, NothingSavedIsNotAnError) {
  body::BodyDefinition definition = *body::MakeDefaultBody(kBody);
  const auto found = store_.Load(definition);
  ASSERT_TRUE(found.ok());
  EXPECT_FALSE(*found);
  const AlignmentStore off("");
  EXPECT_TRUE(off.Prepare().ok());
  EXPECT_TRUE(off.Save(definition).ok());
  EXPECT_FALSE(*off.Load(definition));
}

TEST_F(AlignmentStoreTest, AFileCutOffAnywhereIsRefused) {
  ASSERT_TRUE(store_.Save(aligned_).ok());
  const std::string whole = Text();
  for (std::size_t length = 0; length + 2 < whole.size(); length += 97) {
    Overwrite(whole.substr(0, length));
    EXPECT_NE(Refusal(), "") << "cut off at " << length;
  }
  Overwrite(whole);
  EXPECT_EQ(store_.Load(aligned_).ok(), true);
}

TEST_F(AlignmentStoreTest, WrongContentIsRefusedByName) {
  ASSERT_TRUE(store_.Save(aligned_).ok());
  const std::string whole = Text();
  const auto with = [&](std::string_view from, std::string_view to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    Overwrite(text);
    return Refusal();
  };
  EXPECT_THAT(with("version = 1", "version = 2"), HasSubstr("version must be in [1, 1], is 2"));
  EXPECT_THAT(with("body_id = 3", "body_id = 4"), HasSubstr("body_id must be 3"));
  EXPECT_THAT(with("[l5]", "[tail]"), HasSubstr("segments must be 22"));
  EXPECT_THAT(with("heading_correction_rad = -0.14", "heading_correction_rad = -9.14"),
              HasSubstr("pelvis.heading_correction_rad"));
  EXPECT_THAT(with("sensor_uid = \"fedc", "sensor_uid = \"xedc"), HasSubstr("hexadecimal"));
  EXPECT_THAT(with("q_sensor_segment = [0", "q_sensor_segment = [1"),
              HasSubstr("q_sensor_segment"));
}

TEST_F(AlignmentStoreTest, ARefusedFileIsSetAsideNotLost) {
  Overwrite("this is not TOML");
  ASSERT_TRUE(store_.Save(aligned_).ok());
  EXPECT_TRUE(fs::exists(store_.PathOf(kBody).string() + ".refused"));
  body::BodyDefinition definition = *body::MakeDefaultBody(kBody);
  EXPECT_TRUE(*store_.Load(definition));
}

TEST_F(AlignmentStoreTest, AFailedSaveKeepsTheOldFile) {
  ASSERT_TRUE(store_.Save(aligned_).ok());
  const std::string before = Text();
  fs::create_directory(store_.PathOf(kBody).string() + ".new");  // in the way of the new file
  aligned_.revision = 8;
  EXPECT_FALSE(store_.Save(aligned_).ok());
  EXPECT_EQ(Text(), before);
}

TEST_F(AlignmentStoreTest, SegmentsThatTheBodyDoesNotHaveAreLeftOut) {
  ASSERT_TRUE(store_.Save(aligned_).ok());
  body::BodyDefinition reduced =
      body::KeepSegments(*body::MakeDefaultBody(kBody), body::ReducedSegments());
  const auto found = store_.Load(reduced);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(reduced.segments.size(), 15U);
  EXPECT_TRUE(reduced.segments[1].aligned);
}

TEST(AlignmentStorePrepareTest, AFolderThatCannotBeIsRefusedByName) {
  const Status prepared = AlignmentStore("/proc/no/such").Prepare();
  ASSERT_FALSE(prepared.ok());
  EXPECT_THAT(prepared.error().message, HasSubstr("/proc/no/such"));
}

TEST_F(AlignmentStoreTest, AProfileFollowsAPersonToAnotherBody) {
  ASSERT_TRUE(store_.SaveProfile("Anna", aligned_).ok());
  EXPECT_TRUE(store_.HasProfile("Anna"));
  body::BodyDefinition other = *body::MakeDefaultBody(BodyId{9});
  for (body::SegmentDefinition& segment : other.segments) {
    segment.sensor_uid = SensorUid{0xFEDCBA9876543210ULL + body::Index(segment.segment)};
  }
  const auto aligned = store_.LoadProfile("Anna", other);
  ASSERT_TRUE(aligned.ok()) << aligned.error().message;
  EXPECT_EQ(*aligned, other.segments.size());
  EXPECT_EQ(other.body_id, BodyId{9});
  EXPECT_EQ(other.segments[5].q_sensor_segment.coeffs(),
            aligned_.segments[5].q_sensor_segment.coeffs());
}

TEST_F(AlignmentStoreTest, AProfileAlignsOnlySensorsThatSitWhereItKnowsThem) {
  ASSERT_TRUE(store_.SaveProfile("Anna", aligned_).ok());
  body::BodyDefinition swapped = aligned_;
  for (body::SegmentDefinition& segment : swapped.segments) {
    segment.aligned = false;
    segment.q_sensor_segment.setIdentity();
  }
  std::swap(swapped.segments[15].sensor_uid, swapped.segments[19].sensor_uid);  // the thighs
  ASSERT_TRUE(store_.LoadProfile("Anna", swapped).ok());
  EXPECT_FALSE(swapped.segments[15].aligned);
  EXPECT_FALSE(swapped.segments[19].aligned);
  EXPECT_TRUE(swapped.segments[16].aligned);
}

TEST_F(AlignmentStoreTest, AHalfWrittenProfileIsRefusedAndWhatIsInForceStays) {
  ASSERT_TRUE(store_.SaveProfile("Anna", aligned_).ok());
  std::ifstream file(store_.ProfilePathOf("Anna"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const double share : {0.1, 0.5, 0.9, 0.999}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(text.size()));
    std::ofstream(store_.ProfilePathOf("Anna"), std::ios::trunc) << text.substr(0, length);
    body::BodyDefinition in_force = *body::MakeDefaultBody(kBody);
    const auto loaded = store_.LoadProfile("Anna", in_force);
    ASSERT_FALSE(loaded.ok()) << share;
    EXPECT_THAT(loaded.error().message, HasSubstr("profile_Anna.toml"));
    EXPECT_FALSE(in_force.segments[0].aligned);
    EXPECT_EQ(in_force.segments[1].p_parent_segment_m,
              body::MakeDefaultBody(kBody)->segments[1].p_parent_segment_m);
  }
}

TEST_F(AlignmentStoreTest, NamesOfProfilesAreCheckedAndCannotLeaveTheFolder) {
  EXPECT_EQ(store_.SaveProfile("", aligned_).error().message,
            "a profile's name must have 1 to 48 characters, has 0");
  EXPECT_FALSE(store_.SaveProfile(std::string(49, 'a'), aligned_).ok());
  EXPECT_EQ(store_.ProfilePathOf("../../etc/x").filename(), "profile_______etc_x.toml");
  body::BodyDefinition definition = aligned_;
  EXPECT_EQ(store_.LoadProfile("Bob", definition).error().message, "no profile \"Bob\"");
  EXPECT_EQ(AlignmentStore("").SaveProfile("Anna", aligned_).error().code, ErrorCode::kUnavailable);
}

}  // namespace
}  // namespace limbcast::posture
