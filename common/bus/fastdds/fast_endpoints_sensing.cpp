#include "common/bus/fastdds/fast_endpoints_impl.hpp"

namespace limbcast::bus::fastdds {

LIMBCAST_FAST_ENDPOINTS(sensing::MargSample);
LIMBCAST_FAST_ENDPOINTS(sensing::MargFrame);
LIMBCAST_FAST_ENDPOINTS(sensing::FusedOrientation);
LIMBCAST_FAST_ENDPOINTS(sensing::CoilBurst);
LIMBCAST_FAST_ENDPOINTS(sensing::MarkerPosition);
LIMBCAST_FAST_ENDPOINTS(sensing::PositionFix);
LIMBCAST_FAST_ENDPOINTS(sensing::SensorInfo);

}  // namespace limbcast::bus::fastdds
