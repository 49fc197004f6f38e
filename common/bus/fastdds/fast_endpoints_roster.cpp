#include "common/bus/fastdds/fast_endpoints_impl.hpp"

namespace limbcast::bus::fastdds {

LIMBCAST_FAST_ENDPOINTS(roster::RosterEntry);
LIMBCAST_FAST_ENDPOINTS(roster::SessionState);
LIMBCAST_FAST_ENDPOINTS(roster::JoinRequest);
LIMBCAST_FAST_ENDPOINTS(roster::JoinReply);
LIMBCAST_FAST_ENDPOINTS(roster::Command);
LIMBCAST_FAST_ENDPOINTS(roster::CommandReply);

}  // namespace limbcast::bus::fastdds
