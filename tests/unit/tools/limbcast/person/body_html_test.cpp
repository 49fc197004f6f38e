#include "tools/limbcast/person/body_html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;

TEST(BodyHtmlTest, ShowsEventsPlotsOfBothSidesAndWhatDoesNotHold) {
  BodyTrace trace;
  trace.events = {"3.00 s: aligned <16> segments"};
  for (int i = 0; i < 100; ++i) {
    BodyFrame frame;
    frame.time_s = i * 0.1;
    frame.known.fill(true);
    frame.q_earth_segment.fill(Eigen::Quaterniond::Identity());
    trace.frames.push_back(frame);
  }
  const std::string page =
      BodyHtml("a person", trace, {{"knee", 95.0, 50.0, 85.0}, {"hip", 60.0, 50.0, 85.0}});
  EXPECT_THAT(page, HasSubstr("aligned &lt;16> segments"));
  for (const char* title : {"hip flexion", "knee flexion", "ankle dorsiflexion"}) {
    EXPECT_THAT(page, HasSubstr(title));
  }
  EXPECT_THAT(page, HasSubstr("<td>knee</td><td class='no'>95.0</td>"));
  EXPECT_THAT(page, HasSubstr("<td>hip</td><td class='yes'>60.0</td>"));
  std::size_t curves = 0;
  for (std::size_t at = page.find("<polyline"); at != std::string::npos;
       at = page.find("<polyline", at + 1)) {
    ++curves;
  }
  EXPECT_EQ(curves, 6U);
}

TEST(BodyHtmlTest, ATraceWithoutFramesIsAPageWithoutPlots) {
  EXPECT_THAT(BodyHtml("nobody", {}, {}), ::testing::Not(HasSubstr("<svg")));
}

}  // namespace
}  // namespace limbcast::tool
