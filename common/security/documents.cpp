#include "common/security/documents.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>

namespace limbcast::security {
namespace {

constexpr const char* kHeader = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
constexpr const char* kDomains =
    "<domains><id_range><min>0</min><max>101</max></id_range></domains>\n";

std::string Schema(const std::string& name) {
  return "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-SECURITY/20170901/"
         "omg_shared_ca_" +
         name + ".xsd\">\n";
}

// Both libraries read these elements in this order. Nothing at all for an empty list.
std::string Criteria(const std::string& verb, const std::vector<std::string>& topics) {
  if (topics.empty()) {
    return "";
  }
  std::string xml = "<" + verb + "><topics>\n";
  for (const std::string& topic : topics) {
    xml += "<topic>limbcast/v1/" + topic + "</topic>\n";
  }
  return xml + "</topics><partitions><partition>*</partition></partitions></" + verb + ">\n";
}

}  // namespace

std::string IsoText(Time time) {
  const std::time_t seconds =
      std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  return {text.data(), length};
}

std::string GovernanceXml() {
  return kHeader + Schema("governance") + "<domain_access_rules>\n<domain_rule>\n" + kDomains +
         "<allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
         "<enable_join_access_control>true</enable_join_access_control>\n"
         "<discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
         "<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
         "<rtps_protection_kind>SIGN</rtps_protection_kind>\n"
         "<topic_access_rules>\n<topic_rule>\n<topic_expression>*</topic_expression>\n"
         "<enable_discovery_protection>true</enable_discovery_protection>\n"
         "<enable_liveliness_protection>true</enable_liveliness_protection>\n"
         "<enable_read_access_control>true</enable_read_access_control>\n"
         "<enable_write_access_control>true</enable_write_access_control>\n"
         // Whole submessages, so the payload needs no second encryption.
         "<metadata_protection_kind>ENCRYPT</metadata_protection_kind>\n"
         "<data_protection_kind>NONE</data_protection_kind>\n"
         "</topic_rule>\n</topic_access_rules>\n</domain_rule>\n</domain_access_rules>\n</dds>\n";
}

std::string PermissionsXml(const RoleGrant& grant, const std::string& subject,
                           const Validity& validity) {
  return kHeader + Schema("permissions") + "<permissions>\n<grant name=\"" + grant.role +
         "\">\n<subject_name>" + subject + "</subject_name>\n<validity><not_before>" +
         IsoText(validity.from) + "</not_before><not_after>" + IsoText(validity.until) +
         "</not_after></validity>\n<allow_rule>\n" + kDomains + Criteria("publish", grant.publish) +
         Criteria("subscribe", grant.subscribe) +
         "</allow_rule>\n<default>DENY</default>\n</grant>\n</permissions>\n</dds>\n";
}

std::string ElementOf(const std::string& xml, const std::string& name) {
  const std::string open = "<" + name + ">";
  const std::size_t begin = xml.find(open);
  const std::size_t end = xml.find("</" + name + ">");
  return begin == std::string::npos || end == std::string::npos || end < begin + open.size()
             ? std::string()
             : xml.substr(begin + open.size(), end - begin - open.size());
}

std::string SubjectOf(const std::string& permissions_xml) {
  return ElementOf(permissions_xml, "subject_name");
}

}  // namespace limbcast::security
