#include "services/posture/posture_worker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/support/fake_clock.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};

template <typename T>
class FailingWriter final : public bus::Writer<T> {
 public:
  Status Write(const T&) override {
    return refuse ? Status(Error{ErrorCode::kTimeout, "write refused"}) : Ok();
  }
  Status Dispose(const T&) override { return Ok(); }
  void Flush() override { ++flushes; }
  [[nodiscard]] bus::EndpointCounters counters() const override { return {}; }
  bool refuse = false;
  int flushes = 0;
};

class PostureWorkerTest : public ::testing::Test {
 protected:
  void Give(PostureWorker& worker) {
    EXPECT_TRUE(worker.OfferUrgent(std::make_shared<const roster::RosterEntry>(
        MakeRoster(kBody, {body::Segment::kPelvis, body::Segment::kHead}))));
  }
  StateInput State(body::Segment segment, Time at) {
    return MakeStateInput(MakeState(kBody, segment, at), clock_.Now());
  }

  test_support::FakeClock clock_;
  PostureConfig config_;
  AlignmentStore store_{""};
  FailingWriter<body::Skeleton> skeletons_;
  FailingWriter<body::BodyDefinition> definitions_;
  FailingWriter<roster::CommandReply> replies_;
  PostureCounters counters_;
  PostureLatencies latencies_;
  std::string error_;
  PostureShared shared_{.config = config_,
                        .clock = clock_,
                        .store = store_,
                        .skeletons = skeletons_,
                        .joint_angles = nullptr,
                        .definitions = definitions_,
                        .replies = replies_,
                        .counters = counters_,
                        .latencies = latencies_,
                        .on_error = [this](const std::string& message) { error_ = message; }};
};

TEST_F(PostureWorkerTest, AsksToBeCalledAtTheEarliestDeadline) {
  PostureWorker worker(shared_);
  Give(worker);
  EXPECT_EQ(worker.Drain(), std::nullopt);
  ASSERT_TRUE(worker.Offer(State(body::Segment::kPelvis, clock_.Now())));
  EXPECT_EQ(worker.Drain(), clock_.Now() + 8ms);
  clock_.Advance(8ms);
  EXPECT_EQ(worker.Drain(), std::nullopt);
  EXPECT_EQ(counters_.Read(Count::kSkeletonsDeadline), 1U);
  EXPECT_EQ(worker.body_count(), 1U);
}

TEST_F(PostureWorkerTest, AFullQueueRefusesStatesButKeepsPlacesForTheRest) {
  PostureWorker worker(shared_);
  int taken = 0;
  while (worker.Offer(State(body::Segment::kPelvis, clock_.Now()))) {
    ++taken;
  }
  EXPECT_GT(taken, 1000);
  Give(worker);
  (void)worker.Drain();
  EXPECT_EQ(counters_.Read(Count::kStatesUnassigned), static_cast<std::uint64_t>(taken));
  EXPECT_EQ(worker.body_count(), 1U);
}

TEST_F(PostureWorkerTest, AFailedWriteIsCountedAndNamed) {
  skeletons_.refuse = true;
  PostureWorker worker(shared_);
  Give(worker);
  ASSERT_TRUE(worker.Offer(State(body::Segment::kPelvis, clock_.Now())));
  ASSERT_TRUE(worker.Offer(State(body::Segment::kHead, clock_.Now())));
  (void)worker.Drain();
  EXPECT_EQ(counters_.Read(Count::kPublishErrors), 1U);
  EXPECT_EQ(error_, "write refused");
}

TEST_F(PostureWorkerTest, FlushesOnceForEachDrainThatPublished) {
  PostureWorker worker(shared_);
  Give(worker);
  for (int tick = 0; tick < 5; ++tick) {
    clock_.Advance(10ms);
    ASSERT_TRUE(worker.Offer(State(body::Segment::kPelvis, clock_.Now())));
    ASSERT_TRUE(worker.Offer(State(body::Segment::kHead, clock_.Now())));
  }
  (void)worker.Drain();
  EXPECT_EQ(counters_.Read(Count::kSkeletons), 5U);
  EXPECT_EQ(skeletons_.flushes, 1);
}

TEST_F(PostureWorkerTest, ABrokenAlignmentFileIsReportedAndTheBodyStartsUnaligned) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder / "body_1.toml") << "version = 1\nbody_";
  store_ = AlignmentStore(folder.path());
  PostureWorker worker(shared_);
  Give(worker);
  (void)worker.Drain();
  EXPECT_THAT(error_, HasSubstr("saved alignment refused: "));
  EXPECT_THAT(error_, HasSubstr("body_1.toml"));
  EXPECT_EQ(worker.body_count(), 1U);
}

}  // namespace
}  // namespace limbcast::posture
