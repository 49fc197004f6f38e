#include "services/session/session_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/session/registry_rig.hpp"

namespace limbcast::session {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SessionStoreTest : public ::testing::Test {
 protected:
  SessionStoreTest() : folder_(temporary_ / "state"), store_(folder_) {
    EXPECT_TRUE(store_.Prepare().ok());
    snapshot_.next_session_id = 5;
    snapshot_.next_body_id = 4'000'000'000U;
    KnownSession stage{
        .session_id = 4, .revision = 9, .name = "stage", .created_at = kStart, .people = {}};
    stage.people.push_back({.person = "Ada \"the\" \\ first",
                            .body_id = {1},
                            .client_uid = 0xFEDCBA9876543210ULL,
                            .revision = 3,
                            .coil_slot = 2,
                            .here = true,
                            .left_at = {},
                            .sensors = {On(body::Segment::kPelvis, 0xFFFFFFFFFFFFFFFFULL),
                                        On(body::Segment::kLeftToe, 1)}});
    stage.people.push_back(
        {.person = "Zo\xC3\xAB", .body_id = {2}, .left_at = kStart, .sensors = {}});
    snapshot_.sessions = {
        stage, {.session_id = 1, .revision = 1, .name = "studio", .created_at = {}, .people = {}}};
  }
  std::string Text(const char* name = "sessions.toml") const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void Overwrite(const std::string& text) const {
    std::ofstream(store_.path(), std::ios::trunc) << text;
  }

  const test_support::TemporaryFolder temporary_;
  const fs::path folder_;
  SessionStore store_;
  SessionSnapshot snapshot_;
};

TEST_F(SessionStoreTest, WhatIsSavedComesBack) {
  ASSERT_TRUE(store_.Save(snapshot_).ok());
  const auto loaded = store_.Load();
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_EQ(loaded->snapshot, snapshot_);
  EXPECT_EQ(loaded->warning, "");
}

TEST_F(SessionStoreTest, AtTheFirstStartThereIsNothing) {
  const auto loaded = store_.Load();
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded->snapshot, SessionSnapshot{});
}

TEST_F(SessionStoreTest, NothingIsKeptWithoutAFolder) {
  SessionStore nowhere("");
  EXPECT_TRUE(nowhere.Prepare().ok());
  EXPECT_TRUE(nowhere.Save(snapshot_).ok());
  EXPECT_EQ(nowhere.Load()->snapshot, SessionSnapshot{});
}

TEST_F(SessionStoreTest, CutOffAnywhereTheFileBeforeIsTaken) {
  ASSERT_TRUE(store_.Save(snapshot_).ok());
  SessionSnapshot newer = snapshot_;
  newer.sessions[0].revision = 10;
  ASSERT_TRUE(store_.Save(newer).ok());
  const std::string whole = Text();
  ASSERT_EQ(FromToml(whole, "x")->sessions[0].revision, 10U);
  for (std::size_t size = 0; size + 1 < whole.size(); ++size) {  // the last byte is a newline
    Overwrite(whole.substr(0, size));
    SessionStore store(folder_);
    const auto loaded = store.Load();
    ASSERT_TRUE(loaded.ok()) << size;
    ASSERT_EQ(loaded->snapshot, snapshot_) << size;
    ASSERT_NE(loaded->warning, "") << size;
  }
}

TEST_F(SessionStoreTest, ARefusedFileIsNamedAndSetAside) {
  Overwrite("version = 2\n[end]\n");
  const auto refused = store_.Load();
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kCorruptData);
  EXPECT_THAT(refused.error().message,
              HasSubstr("sessions.toml:1: version must be in [1, 1], is 2"));
  ASSERT_TRUE(store_.Save(snapshot_).ok());
  EXPECT_EQ(Text("sessions.toml.refused"), "version = 2\n[end]\n");
  EXPECT_EQ(store_.Load()->snapshot, snapshot_);
}

TEST_F(SessionStoreTest, WrongValuesAreRefusedByNameAndLine) {
  const std::string good = ToToml(snapshot_);
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string bad = good;
    bad.replace(bad.find(from), from.size(), to);
    const auto read = FromToml(bad, "s.toml");
    return read.ok() ? "accepted" : read.error().message;
  };
  EXPECT_THAT(refusal("\"fedcba9876543210\"", "\"0x1\""), HasSubstr("client_uid must be 16 hex"));
  EXPECT_THAT(refusal("pelvis ffff", "nose ffff"), HasSubstr("sensors must be segments and uids"));
  EXPECT_THAT(refusal("ffffffffffffffff", "fffffffffffffff"), HasSubstr("sensors"));
  EXPECT_THAT(refusal("people = 2", "people = 3"), HasSubstr("end.people"));
  EXPECT_THAT(refusal("coil_slot = 2", "coil_slot = -2"), HasSubstr("coil_slot"));
  EXPECT_THAT(refusal("here = true", "here = true\nmood = 1"), HasSubstr("mood"));
}

TEST_F(SessionStoreTest, ADiskThatRefusesIsReported) {
  ASSERT_TRUE(store_.Save(snapshot_).ok());
  fs::create_directory(store_.path().string() + ".new");  // cannot be written over, whoever we are
  const Status saved = store_.Save(SessionSnapshot{});
  ASSERT_FALSE(saved.ok());
  EXPECT_EQ(saved.error().code, ErrorCode::kUnavailable);
  EXPECT_THAT(saved.error().message, HasSubstr("sessions.toml.new"));
  EXPECT_EQ(store_.Load()->snapshot, snapshot_) << "the one before is whole";
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THAT(SessionStore(folder_ / "file").Prepare().error().message,
              HasSubstr("session.state_dir"));
}

}  // namespace
}  // namespace limbcast::session
