#include "tools/limbcast/demo/demo_options.hpp"

namespace limbcast::tool {

std::string_view ToString(DemoDds dds) {
  switch (dds) {
    case DemoDds::kCyclone:
      return "cyclone";
    case DemoDds::kFast:
      return "fast";
    case DemoDds::kMixed:
      return "mixed";
  }
  return "unknown";
}

std::string_view VendorOf(DemoDds dds, std::string_view process) {
  if (dds != DemoDds::kMixed) {
    return ToString(dds);
  }
  return process == "gateway" || process == "posture" ? "cyclone" : "fast";
}

}  // namespace limbcast::tool
