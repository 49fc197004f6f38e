#include "common/bus/cyclone/cyclone_endpoints_impl.hpp"

namespace limbcast::bus::cyclone {

LIMBCAST_CYCLONE_ENDPOINTS(body::SegmentState);
LIMBCAST_CYCLONE_ENDPOINTS(body::SegmentFrame);
LIMBCAST_CYCLONE_ENDPOINTS(body::SegmentTruth);
LIMBCAST_CYCLONE_ENDPOINTS(body::BodyDefinition);
LIMBCAST_CYCLONE_ENDPOINTS(body::Skeleton);
LIMBCAST_CYCLONE_ENDPOINTS(body::JointAngleFrame);
LIMBCAST_CYCLONE_ENDPOINTS(ServiceHealth);

}  // namespace limbcast::bus::cyclone
