#include "tools/limbcast/doctor/host_facts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace limbcast::tool {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(HostFactsTest, CountsNumbersOfTheDomainByTheirDiscoveryPort) {
  // Domain 2: 7910, 7912, ... are for discovery, 7911 is for data, 7900 the group of all.
  EXPECT_EQ(CountParticipants({7900, 7910, 7911, 7912, 7913, 8148, 8150, 7410}, 2), 3U);
  EXPECT_EQ(CountParticipants({}, 2), 0U);
}

class StaleSharedMemoryTest : public ::testing::Test {
 protected:
  StaleSharedMemoryTest() {
    fs::create_directories(shm_);
    fs::create_directories(proc_ / "17" / "fd");
    for (const char* name : {"fastrtps_mapped", "fastrtps_open", "sem.fastrtps_gone_mutex",
                             "fastrtps_gone", "somebody_elses"}) {
      std::ofstream(shm_ / name) << "x";
    }
    std::ofstream(proc_ / "17" / "maps")
        << "7f00-7f01 rw-s 00000000 00:1a 5    " << (shm_ / "fastrtps_mapped").string() << "\n";
    fs::create_symlink(shm_ / "fastrtps_open", proc_ / "17" / "fd" / "3");
  }
  const test_support::TemporaryFolder folder_;
  const fs::path shm_ = folder_ / "shm";
  const fs::path proc_ = folder_ / "proc";
};

TEST_F(StaleSharedMemoryTest, IsWhatNobodyHasOpenOrMapped) {
  EXPECT_THAT(StaleSharedMemory(shm_, proc_),
              ElementsAre("fastrtps_gone", "sem.fastrtps_gone_mutex"));
}

TEST_F(StaleSharedMemoryTest, IsNothingWhereThereIsNoFolder) {
  EXPECT_THAT(StaleSharedMemory(shm_ / "none", proc_), IsEmpty());
}

TEST_F(StaleSharedMemoryTest, NumbersAreReadFromFiles) {
  std::ofstream(folder_ / "rmem_max") << "212992\n";
  EXPECT_EQ(NumberIn(folder_ / "rmem_max"), 212992);
  EXPECT_EQ(NumberIn(folder_ / "none"), 0);
}

}  // namespace
}  // namespace limbcast::tool
