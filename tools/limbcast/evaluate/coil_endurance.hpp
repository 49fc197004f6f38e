#pragma once

#include <cstdint>
#include <functional>

#include "common/filters/position/coil_inertial_config.hpp"
#include "common/simulation/coil_stream.hpp"

namespace limbcast::tool {

/// A simulated person with a source on the pelvis (or a source that stands) and a sensor on an arm
/// of two links, 12 to 55 cm above it: everything drawn from the seed, lengths, paces, turns,
/// pulses (thesis or bipolar, by turns), noise (50 or 15 nT), gradient, errors of both inertial
/// units. At rest for the first 2.5 s; the motion swells and dies away every minute or two.
struct CoilSubject {
  simulation::CoilStreamConfig stream;
  filters::CoilInertialConfig filter;
};
[[nodiscard]] CoilSubject MakeCoilSubject(std::uint64_t seed);

/// What a filter did over some simulated time. It *flips* when it is tracking and nearer to the
/// mirror image of the truth, −p, than to p; it *diverges* when it is tracking and for a second on
/// end further off than a tenth of the range and 5 cm, when its state is not finite, or when
/// without any cause it does not track for 2 s.
struct CoilEndurance {
  double hours = 0.0;  ///< scored
  int runs = 0;
  int diverged = 0;       ///< runs
  int flips = 0;          ///< frames
  int losses = 0;         ///< that the filter itself declared
  int injected = 0;       ///< losses made
  int late = 0;           ///< injected ones after which it took more than 2 s to be right again
  int mirrored = 0;       ///< of the runs that moved the estimate to the other side, how many times
  int mirrored_late = 0;  ///< the same as `late` of those, which are not in `injected`
  double slowest_s = 0.0;  ///< of an injected one
  double rms_m = 0.0;      ///< forward, tracking, injected losses and their recovery left out
};

/// Sum of two; rms_m over the time of both.
[[nodiscard]] CoilEndurance operator+(const CoilEndurance& a, const CoilEndurance& b);

/// One subject for `duration_s`, scored from 5 s on.
///
/// @param loss_every_s  > 4: so often track is taken away, in turn by moving the estimate (half a
///                      metre, or nearly to the mirror image) without telling the covariance, by
///                      3 s without a magnetometer, and by 1 s of nonsense from it. The time to
///                      recover counts from the moment when readings are right again. The mirror
///                      image is counted apart: pulses cannot tell it from the truth, only motion
///                      can, and no track gets there by itself. 0: never.
/// @param progress      called now and then with the simulated time; may be empty.
[[nodiscard]] CoilEndurance RunCoilSubject(std::uint64_t seed, double duration_s,
                                           double loss_every_s,
                                           const std::function<void(double)>& progress = {});

/// `count` subjects of 20 s, seeds `first_seed` and up; every second one with a loss every 6 s.
[[nodiscard]] CoilEndurance RunCoilSubjects(std::uint64_t first_seed, int count,
                                            const std::function<void(int)>& progress = {});

}  // namespace limbcast::tool
