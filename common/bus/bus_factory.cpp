#include "common/bus/bus_factory.hpp"

#include "common/bus/inproc/inproc_bus.hpp"
#include "common/bus/system_now.hpp"
#include "common/security/credentials.hpp"
#ifdef LIMBCAST_BUS_HAS_CYCLONE
#include "common/bus/cyclone/cyclone_bus.hpp"
#endif
#ifdef LIMBCAST_BUS_HAS_FASTDDS
#include "common/bus/fastdds/fast_bus.hpp"
#endif

namespace limbcast::bus {
namespace {

// A library says little about credentials that it refuses, and nothing at all when it is the peer
// that refuses them: what can be found wrong with them is found here.
Status CheckSecurity(const BusConfig& config) {
  if (config.security_dir.empty()) {
    return Ok();
  }
  if (config.vendor == Vendor::kInproc) {
    return Error{ErrorCode::kInvalidArgument,
                 "bus.security_dir: inproc has no network that could be secured"};
  }
  const auto library =
      config.vendor == Vendor::kFast ? security::Library::kFast : security::Library::kCyclone;
  const auto files =
      security::CheckCredentials(config.security_dir, config.security_role, library, SystemNow());
  return files ? Ok() : Status(files.error());
}

}  // namespace

Result<std::unique_ptr<Bus>> Open(const BusConfig& config, BusEventHandler on_event) {
  if (const Status valid = Validate(config); !valid) {
    return valid.error();
  }
  if (const Status secured = CheckSecurity(config); !secured) {
    return secured.error();
  }
  switch (config.vendor) {
    case Vendor::kInproc:
      return inproc::MakeBus(inproc::SharedHub(config.domain_id), config, std::move(on_event));
    case Vendor::kCyclone:
#ifdef LIMBCAST_BUS_HAS_CYCLONE
      return cyclone::OpenCyclone(config, std::move(on_event));
#else
      return Error{ErrorCode::kUnsupported, "bus.dds = cyclone: built without Cyclone DDS"};
#endif
    case Vendor::kFast:
#ifdef LIMBCAST_BUS_HAS_FASTDDS
      return fastdds::OpenFast(config, std::move(on_event));
#else
      return Error{ErrorCode::kUnsupported, "bus.dds = fast: built without Fast DDS"};
#endif
  }
  return Error{ErrorCode::kUnsupported,
               "bus.dds has no back end " + std::to_string(static_cast<int>(config.vendor))};
}

}  // namespace limbcast::bus
