#include "tools/limbcast/evaluate/coil_beyond.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/limbcast/evaluate/coil_adaptive.hpp"

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;

const CoilLiveFigures& Of(const CoilBeyondResult& result, CoilVariant variant) {
  return result.variants[static_cast<std::size_t>(variant)];
}

TEST(CoilBeyondTest, EveryGainIsThereOnAMotionThatIsNoneOfTheTables) {
  CoilExperiment experiment = MakeRestingExperiment();
  experiment.duration_s = 40.0;
  const CoilBeyondResult result = EvaluateBeyond(experiment, CoilNoise::kThesis, 9);
  const auto& pulses = Of(result, CoilVariant::kPulses);
  for (const CoilLiveFigures& v : result.variants) {
    EXPECT_GT(v.tracking.tracked, 0.99);
    EXPECT_LT(v.lagged.position_m, v.forward.position_m);
  }
  EXPECT_LT(Of(result, CoilVariant::kTones).forward.position_m, pulses.forward.position_m);
  EXPECT_LT(Of(result, CoilVariant::kTonesFast).forward.position_m,
            Of(result, CoilVariant::kPulsesFast).forward.position_m);
}

TEST(CoilBeyondTest, TheTableAndTheFileHaveEverySource) {
  CoilBeyondResult result;
  result.experiment = "arm walking";
  for (std::size_t i = 0; i < kCoilVariantCount; ++i) {
    const double mm = 1.0 + static_cast<double>(i);
    result.variants[i].forward.position_m = 1e-3 * mm;
    result.variants[i].lagged.position_m = 0.5e-3 * mm;
    result.variants[i].tracking.tracked = i == 2 ? 0.9 : 1.0;
  }
  const std::string table = BeyondTable({&result, 1});
  EXPECT_THAT(table, HasSubstr("arm walking"));
  EXPECT_THAT(table, HasSubstr("coils apart"));
  EXPECT_THAT(table, HasSubstr("  3.0 /  1.5   0.00*"));
  EXPECT_THAT(table, HasSubstr("  5.0 /  2.5   0.00 "));
  const nlohmann::json json = BeyondJson({&result, 1}, 7);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["trials"][0]["tones 400 Hz"]["forward"]["position_m"], 5e-3);
}

}  // namespace
}  // namespace limbcast::tool
