#include "common/bus/fastdds/fast_endpoints_impl.hpp"

namespace limbcast::bus::fastdds {

LIMBCAST_FAST_ENDPOINTS(body::SegmentState);
LIMBCAST_FAST_ENDPOINTS(body::SegmentFrame);
LIMBCAST_FAST_ENDPOINTS(body::SegmentTruth);
LIMBCAST_FAST_ENDPOINTS(body::BodyDefinition);
LIMBCAST_FAST_ENDPOINTS(body::Skeleton);
LIMBCAST_FAST_ENDPOINTS(body::JointAngleFrame);
LIMBCAST_FAST_ENDPOINTS(ServiceHealth);

}  // namespace limbcast::bus::fastdds
