#include "common/bus/cyclone/cyclone_endpoints_impl.hpp"

namespace limbcast::bus::cyclone {

LIMBCAST_CYCLONE_ENDPOINTS(roster::RosterEntry);
LIMBCAST_CYCLONE_ENDPOINTS(roster::SessionState);
LIMBCAST_CYCLONE_ENDPOINTS(roster::JoinRequest);
LIMBCAST_CYCLONE_ENDPOINTS(roster::JoinReply);
LIMBCAST_CYCLONE_ENDPOINTS(roster::Command);
LIMBCAST_CYCLONE_ENDPOINTS(roster::CommandReply);

}  // namespace limbcast::bus::cyclone
