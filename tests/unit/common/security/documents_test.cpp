#include "common/security/documents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/security/security_examples.hpp"

namespace limbcast::security {
namespace {

using ::testing::HasSubstr;
using testing::kToday;
using ::testing::Not;

TEST(DocumentsTest, GovernanceLeavesNothingInTheClear) {
  const std::string xml = GovernanceXml();
  EXPECT_THAT(xml, HasSubstr("<allow_unauthenticated_participants>false<"));
  EXPECT_THAT(xml, HasSubstr("<discovery_protection_kind>ENCRYPT<"));
  EXPECT_THAT(xml, HasSubstr("<metadata_protection_kind>ENCRYPT<"));
  EXPECT_THAT(xml, HasSubstr("<topic_expression>*<"));
}

TEST(DocumentsTest, PermissionsAllowWhatIsGrantedAndDenyTheRest) {
  const std::string xml =
      PermissionsXml({"fusion", {"segment_state"}, {"marg"}}, "CN=fusion,O=Limbcast", kToday);
  EXPECT_THAT(xml, HasSubstr("<publish><topics>\n<topic>limbcast/v1/segment_state</topic>"));
  EXPECT_THAT(xml, HasSubstr("<subscribe><topics>\n<topic>limbcast/v1/marg</topic>"));
  EXPECT_THAT(xml, HasSubstr("<default>DENY</default>"));
  EXPECT_EQ(SubjectOf(xml), "CN=fusion,O=Limbcast");
}

TEST(DocumentsTest, WhoMayPublishNothingHasNoListOfIt) {
  EXPECT_THAT(PermissionsXml({"spectator", {}, {"skeleton"}}, "CN=s", kToday),
              Not(HasSubstr("<publish>")));
}

TEST(DocumentsTest, TimesAreInUtc) {
  EXPECT_EQ(IsoText(TimeFromNanoseconds(0)), "1970-01-01T00:00:00");
  EXPECT_EQ(IsoText(TimeFromNanoseconds(951'782'400'999'999'999)), "2000-02-29T00:00:00");
}

TEST(DocumentsTest, OtherTextNamesNobody) {
  EXPECT_EQ(SubjectOf(""), "");
  EXPECT_EQ(SubjectOf("</subject_name><subject_name>"), "");
}

}  // namespace
}  // namespace limbcast::security
