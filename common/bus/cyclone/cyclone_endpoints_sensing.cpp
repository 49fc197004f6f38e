#include "common/bus/cyclone/cyclone_endpoints_impl.hpp"

namespace limbcast::bus::cyclone {

LIMBCAST_CYCLONE_ENDPOINTS(sensing::MargSample);
LIMBCAST_CYCLONE_ENDPOINTS(sensing::MargFrame);
LIMBCAST_CYCLONE_ENDPOINTS(sensing::FusedOrientation);
LIMBCAST_CYCLONE_ENDPOINTS(sensing::CoilBurst);
LIMBCAST_CYCLONE_ENDPOINTS(sensing::MarkerPosition);
LIMBCAST_CYCLONE_ENDPOINTS(sensing::PositionFix);
LIMBCAST_CYCLONE_ENDPOINTS(sensing::SensorInfo);

}  // namespace limbcast::bus::cyclone
