// Does the coil filter hold out? Long simulated time, many subjects, track taken away on purpose.
// The figures of whole days are those of `limbcast evaluate coil --hours 10 --runs 1000`, which
// runs the same code from the same seed.
#include "tools/limbcast/evaluate/coil_endurance.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "common/simulation/random.hpp"

namespace limbcast::tool {
namespace {

void Print(const char* what, const CoilEndurance& e) {
  std::cout << what << ": " << e.hours << " h, " << e.runs << " runs, " << e.diverged
            << " diverged, " << e.flips << " flips, " << e.losses << " losses, " << e.injected
            << " injected, " << e.mirrored << " mirrored (" << e.mirrored_late << " late), "
            << e.late << " late, slowest " << e.slowest_s << " s, RMS " << 1e3 * e.rms_m << " mm\n";
}

TEST(CoilEnduranceTest, AnHourOfOneSubjectWithoutAFlip) {
  const CoilEndurance hour = RunCoilSubject(simulation::kDefaultSeed, 3600.0, 0.0);
  Print("one subject", hour);
  EXPECT_EQ(hour.flips, 0);
  EXPECT_EQ(hour.diverged, 0);
  EXPECT_EQ(hour.losses, 0);
}

TEST(CoilEnduranceTest, SubjectsThatDoNotDivergeAndComeBackWithinTwoSeconds) {
  const CoilEndurance many = RunCoilSubjects(simulation::kDefaultSeed, 200);
  Print("subjects", many);
  EXPECT_EQ(many.runs, 200);
  EXPECT_EQ(many.diverged, 0);
  EXPECT_EQ(many.flips, 0);
  EXPECT_GE(many.injected, 90);
  EXPECT_GE(many.mirrored, 90);
  EXPECT_LE(many.mirrored_late, 5);
  EXPECT_EQ(many.late, 0) << "slowest " << many.slowest_s << " s";
}

}  // namespace
}  // namespace limbcast::tool
