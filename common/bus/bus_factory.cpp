#include "common/bus/bus_factory.hpp"

#include "common/bus/inproc/inproc_bus.hpp"
#ifdef LIMBCAST_BUS_HAS_CYCLONE
#include "common/bus/cyclone/cyclone_bus.hpp"
#endif
#ifdef LIMBCAST_BUS_HAS_FASTDDS
#include "common/bus/fastdds/fast_bus.hpp"
#endif

namespace limbcast::bus {

Result<std::unique_ptr<Bus>> Open(const BusConfig& config, BusEventHandler on_event) {
  if (const Status valid = Validate(config); !valid) {
    return valid.error();
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
