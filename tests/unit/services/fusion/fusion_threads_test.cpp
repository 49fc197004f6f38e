// The fusion service on real threads: same states for any number of workers, nothing lost when
// everything changes at once.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <thread>

#include "common/runtime/thread_pool.hpp"
#include "services/fusion/fusion_service.hpp"
#include "tests/unit/services/fusion/fusion_fixture.hpp"

namespace limbcast::fusion {
namespace {

constexpr std::uint32_t kBodies = 5;
constexpr std::uint32_t kSensorsPerBody = 3;

// What one run says, body by body, in the order in which it was said.
std::map<std::uint32_t, std::vector<body::SegmentState>> RunWith(std::size_t workers,
                                                                 const std::string& filter) {
  FusionWorld world;
  runtime::ThreadPool pool("fusion", workers);
  FusionConfig config = CountingConfig();
  if (filter != "counting") {
    config.filter.name = filter;
  }
  FusionService service(config, world.clock, *world.inside, pool,
                        filter != "counting" ? FilterFactory{} : CountingFilters());
  EXPECT_TRUE(service.Start().ok());
  for (std::uint32_t b = 1; b <= kBodies; ++b) {
    world.Assign(b, {{b * 10, body::Segment::kHead},
                     {b * 10 + 1, body::Segment::kPelvis},
                     {b * 10 + 2, body::Segment::kLeftFoot}});
  }
  std::mt19937 rng(20240517);
  std::normal_distribution<float> noise(0.0F, 0.3F);
  for (std::uint32_t i = 1; i <= 200; ++i) {
    for (std::uint32_t b = 1; b <= kBodies; ++b) {
      for (std::uint32_t s = 0; s < kSensorsPerBody; ++s) {
        sensing::MargSample sample = world.Sample(b * 10 + s, i);
        sample.gyro_rad_s = {noise(rng), noise(rng), noise(rng)};
        sample.accel_m_s2 = {noise(rng), noise(rng), 9.81F + noise(rng)};
        sample.mag_tesla = {1e-6F * noise(rng), 2e-5F, -4e-5F};
        if (i % 31 == 0) {
          sample.accel_m_s2.x() = std::numeric_limits<float>::quiet_NaN();
          sample.gyro_rad_s.x() = std::numeric_limits<float>::quiet_NaN();
        }
        world.Send(sample);
      }
    }
    if (i == 100) {  // a change in the middle, in order with the samples
      world.Assign(2, {{20, body::Segment::kNeck}, {21, body::Segment::kPelvis}});
    }
  }
  service.Stop();
  std::map<std::uint32_t, std::vector<body::SegmentState>> by_body;
  for (const body::SegmentState& state : world.states) {
    by_body[state.body_id.value].push_back(state);
  }
  EXPECT_EQ(service.counters().received, 200U * kBodies * kSensorsPerBody);
  return by_body;
}

void ExpectSame(const body::SegmentState& a, const body::SegmentState& b) {
  ASSERT_EQ(a.segment, b.segment);
  ASSERT_EQ(a.sensor_uid, b.sensor_uid);
  ASSERT_EQ(a.sequence, b.sequence);
  ASSERT_EQ(a.verdict, b.verdict);
  ASSERT_EQ(a.started, b.started);
  ASSERT_EQ(a.verdicts, b.verdicts);
  ASSERT_EQ(a.lost_count, b.lost_count);
  const auto same_bits = [](const auto& x, const auto& y) {
    return std::memcmp(&x, &y, sizeof(x)) == 0;
  };
  ASSERT_TRUE(same_bits(a.q_earth_sensor, b.q_earth_sensor));
  ASSERT_TRUE(same_bits(a.w_earth_sensor_in_sensor_rad_s, b.w_earth_sensor_in_sensor_rad_s));
  ASSERT_TRUE(same_bits(a.cov_orientation_rad2, b.cov_orientation_rad2));
}

class FusionWorkersTest : public ::testing::TestWithParam<std::string> {};

TEST_P(FusionWorkersTest, TheStatesOfABodyDoNotDependOnTheNumberOfWorkers) {
  const auto reference = RunWith(1, GetParam());
  ASSERT_EQ(reference.size(), kBodies);
  for (const std::size_t workers : {2U, 3U, 8U}) {
    const auto states = RunWith(workers, GetParam());
    ASSERT_EQ(states.size(), kBodies);
    for (const auto& [body_id, expected] : reference) {
      const auto& actual = states.at(body_id);
      ASSERT_EQ(actual.size(), expected.size()) << "body " << body_id;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ExpectSame(actual[i], expected[i]);
      }
    }
  }
}

// The filters of several bodies share batches, by chance of arrival: that changes no bit either.
INSTANTIATE_TEST_SUITE_P(Filters, FusionWorkersTest, ::testing::Values("counting", "tqt", "bmf"),
                         [](const auto& tested) { return tested.param; });

// Under the thread sanitizer: several writers, changes of the roster and of filters, health, all at
// once; and every sample is accounted for.
TEST(FusionThreadsTest, EverySampleIsAccountedForWhileEverythingChanges) {
  FusionWorld world;
  runtime::ThreadPool pool("fusion", 3);
  FusionService service(CountingConfig(), world.clock, *world.inside, pool, CountingFilters());
  ASSERT_TRUE(service.Start().ok());
  constexpr std::uint32_t kEach = 2'000;
  for (std::uint32_t b = 1; b <= 4; ++b) {
    world.Assign(b, {{b, body::Segment::kHead}});
  }
  std::vector<std::thread> senders;
  for (std::uint32_t b = 1; b <= 4; ++b) {
    senders.emplace_back([&world, b] {
      const auto writer = *world.outside->MakeWriter<sensing::MargSample>();
      for (std::uint32_t i = 1; i <= kEach; ++i) {
        EXPECT_TRUE(writer->Write(world.Sample(b, i)).ok());
      }
    });
  }
  senders.emplace_back([&world] {
    roster::Command command;
    command.kind = roster::CommandKind::kSelectFilter;
    for (int i = 0; i < 100; ++i) {
      ++command.request_id;
      command.text = i % 2 == 0 ? "slow" : "tqt";
      EXPECT_TRUE(world.command->Write(command).ok());
      world.Assign(3, {{3, i % 2 == 0 ? body::Segment::kNeck : body::Segment::kHead}});
    }
  });
  senders.emplace_back([&service] {
    for (int i = 0; i < 100; ++i) {
      ServiceHealth health;
      service.FillHealth(health);
    }
  });
  for (std::thread& sender : senders) {
    sender.join();
  }
  service.Stop();
  const FusionCounters counters = service.counters();
  EXPECT_EQ(counters.received, 4U * kEach);
  EXPECT_EQ(counters.lost, 0);
  const std::uint64_t overload = counters.verdicts[SampleVerdict::kRejectedOverload];
  EXPECT_EQ(counters.verdicts.used() + overload, 4U * kEach);
  EXPECT_EQ(world.states.size() + overload, 4U * kEach);
}

}  // namespace
}  // namespace limbcast::fusion
