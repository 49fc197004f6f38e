// The figures of the publications, reached in simulation: acceptance of the filters. A bound is the
// published figure unless a reason stands beside it. `limbcast evaluate published` prints the whole
// table with ten repetitions; here there are four, which scatter by half a deviation.
#include "tools/limbcast/evaluate/published_figures.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace limbcast::tool {
namespace {

// Mean (or largest) in degrees: experiment and figure → filter → value.
using Figures = std::map<std::string, std::map<std::string, double>>;

Figures Compute(const std::string& experiment) {
  PublishedOptions options;
  options.trials = 4;
  options.only = experiment;
  for (const char* label :
       {"tqt", "ckf", "ckf-thesis", "ckf-iron", "ckf-plain", "bmf", "bmf-plain", "gyro"}) {
    options.filters.push_back(*FindFigureFilter(label));
  }
  Figures figures;
  for (const PublishedRow& row : ComputePublishedRows(options)) {
    for (const auto& [label, spread] : row.simulated) {
      figures[row.what][label] = row.worst ? spread.max_deg : spread.mean_deg;
    }
  }
  return figures;
}

// 10 minutes at rest beside iron: 0.6° rms.
TEST(PublishedFiguresTest, TenMinutesBesideIron) {
  const auto change = Compute("static").at("10 min beside iron: rms of the change");
  EXPECT_LT(change.at("bmf"), 0.6);
  // Not 0.6: the simulated gyro wanders by 0.01°/s/√s (not printed; figure 2.7 is met) and neither
  // of these filters takes rest for a measurement of its offset. Measured 2.9 and 7.0, a third of
  // margin; integration alone drifts a hundred degrees.
  EXPECT_LT(change.at("ckf-iron"), 4.0);
  EXPECT_LT(change.at("tqt"), 10.0);
  EXPECT_GT(change.at("gyro"), 40.0);  // what they are up against
}

// At rest between quarter turns: 1.3° mean, 1.5° beside iron, without compensation up to 40°.
TEST(PublishedFiguresTest, QuarterTurnsWithAndWithoutIron) {
  const Figures figures = Compute("quasi-static");
  const auto& clean = figures.at("without iron: mean at rest");
  const auto& iron = figures.at("iron at 5 cm: mean at rest");
  const auto& largest = figures.at("iron at 5 cm: largest");
  EXPECT_LT(clean.at("bmf"), 1.3);
  EXPECT_LT(iron.at("bmf"), 1.5);
  // The thesis took c_d from moving near iron; with a memory of 10 s its filter reaches its
  // figures. Four repetitions of a figure with a deviation of 1° leave 0.5°.
  EXPECT_LT(clean.at("ckf-iron"), 1.3 + 0.5);
  EXPECT_LT(iron.at("ckf-iron"), 1.5 + 0.5);
  // The shipped c_d of 0.98 per 10 ms forgets within half a second that there is iron.
  EXPECT_LT(iron.at("ckf"), iron.at("ckf-plain"));
  EXPECT_GT(largest.at("ckf-plain"), 15.0);
  EXPECT_LT(largest.at("ckf-plain"), 40.0);
  EXPECT_LT(largest.at("bmf"), 4.0);
  // The sensor is as bad as the one of figure 2.7.
  EXPECT_GT(figures.at("after one minute (gyro alone)").at("gyro"), 10.0);
  EXPECT_LT(figures.at("after one minute (gyro alone)").at("gyro"), 25.0);
}

// The fore arm on the table: 1.3° rms, up to 2.4° the closer the iron and the faster the arm.
TEST(PublishedFiguresTest, ForeArmBesideIron) {
  const Figures figures = Compute("elbow");
  for (const char* hz : {"0.25", "0.50", "1.00", "2.00"}) {
    SCOPED_TRACE(hz);
    const auto figure = [&](const std::string& iron, const std::string& kind) {
      return figures.at(iron + ", " + hz + " Hz: " + kind + ", rms");
    };
    EXPECT_LT(figure("no iron", "angle").at("bmf"), 1.3);
    EXPECT_LT(figure("no iron", "angle").at("ckf"), 1.3);
    EXPECT_LT(figure("iron at 10 cm", "angle").at("bmf"), 1.3);
    EXPECT_LT(figure("iron at 10 cm", "angle").at("ckf"), 2.4);
    EXPECT_LT(figure("iron at 5 cm", "angle").at("bmf"), 1.3);
    EXPECT_LT(figure("iron at 5 cm", "angle").at("ckf"), 2.4);
    // All three axes, heading too, which the potentiometer of the thesis could not see.
    EXPECT_LT(figure("no iron", "whole orientation").at("bmf"), 1.5);
    EXPECT_LT(figure("iron at 5 cm", "whole orientation").at("bmf"), 2.4);
  }
}

// Arm movements: 2.6° rms, near a steel case 3.6°, without compensation 13.1°.
TEST(PublishedFiguresTest, ArmBeforeASteelCase) {
  const Figures figures = Compute("arm");
  const auto& clean = figures.at("no metal: rms");
  const auto& metal = figures.at("near metal: rms");
  for (const char* filter : {"tqt", "ckf", "ckf-thesis", "ckf-iron", "ckf-plain", "bmf"}) {
    EXPECT_LT(clean.at(filter), 2.6) << filter;
  }
  EXPECT_LT(metal.at("bmf"), 2.0);
  EXPECT_LT(metal.at("ckf-iron"), 3.6);
  // Without compensation, within a factor of two of the published error: the case is as magnetic
  // as theirs. The shipped ckf lies between.
  EXPECT_GT(metal.at("ckf-plain"), 13.1 / 2.0);
  EXPECT_LT(metal.at("ckf-plain"), 13.1 * 2.0);
  EXPECT_LT(metal.at("ckf"), metal.at("ckf-plain"));
}

// Assembly work on the case: 3.6° with compensation, 19.8° without.
TEST(PublishedFiguresTest, AssemblyOnASteelCase) {
  const auto metal = Compute("assembly").at("on a metal case: rms");
  EXPECT_LT(metal.at("bmf"), 3.6);
  EXPECT_LT(metal.at("ckf-iron"), 3.6);
  EXPECT_GT(metal.at("ckf-plain"), 19.8 / 2.0);
  EXPECT_LT(metal.at("ckf-plain"), 19.8 * 2.0);
}

// Same seed, same figures, to the last bit.
TEST(PublishedFiguresTest, AreTheSameForTheSameSeed) {
  PublishedOptions options;
  options.trials = 1;
  options.only = "assembly";
  options.filters = {*FindFigureFilter("bmf"), *FindFigureFilter("gyro")};
  const auto first = ComputePublishedRows(options);
  const auto second = ComputePublishedRows(options);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].simulated.at("bmf").mean_deg, second[0].simulated.at("bmf").mean_deg);
  options.seed = 1;
  const auto other = ComputePublishedRows(options);
  EXPECT_NE(first[0].simulated.at("gyro").mean_deg, other[0].simulated.at("gyro").mean_deg);
}

// Table 1 of the theory report by the rule of design/orientation.md section 7: columns 2 and 3
// within a tenth, the first cell between the two ways to take the error, and quadratic convergence
// without noise (published in single precision).
TEST(PublishedFiguresTest, TableOneOfTheTheoryReport) {
  const auto rows = ComputeTableOne(simulation::kDefaultSeed);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_GT(rows[0].simulated[0], 4.9e-3);
  EXPECT_LT(rows[0].simulated[0], 7.6e-3);
  EXPECT_LT(rows[0].simulated[1], rows[0].published[1]);
  EXPECT_LT(rows[0].simulated[2], rows[0].published[2]);
  for (std::size_t row = 1; row < rows.size(); ++row) {
    for (std::size_t column = 1; column < 3; ++column) {
      EXPECT_NEAR(rows[row].simulated[column], rows[row].published[column],
                  0.1 * rows[row].published[column]);
    }
  }
}

}  // namespace
}  // namespace limbcast::tool
