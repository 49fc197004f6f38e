#include "common/bus/cyclone/cyclone_domain.hpp"

#include <arpa/inet.h>
#include <dds/dds.h>

#include <map>
#include <mutex>
#include <utility>

#include "common/bus/cyclone/cyclone_log.hpp"

namespace limbcast::bus::cyclone {
namespace {

// DDSI-RTPS 2.3 section 9.6.1.1: unicast discovery port = 7400 + 250 domain + 10 + 2 index.
constexpr std::uint32_t kPortBase = 7400;
constexpr std::uint32_t kPortsPerDomain = 250;
constexpr std::uint32_t kFirstUnicastOffset = 10;
// So many processes of one host may join a domain (the next one would use another domain's ports);
constexpr std::uint32_t kMaxParticipantIndex = 119;
// those with a low index are called, the others call. Each port costs a packet each interval.
constexpr std::uint32_t kCalledOnThisHost = 40;
constexpr std::uint32_t kCalledOnOtherHosts = 16;

bool IsAddress(const std::string& text) {
  in6_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1 ||
         inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

std::string PeersXml(const BusConfig& config, const std::string& host, std::uint32_t count) {
  if (host.find(':') != std::string::npos) {  // names its port
    return "<Peer address=\"" + host + "\"/>";
  }
  std::string xml;
  for (std::uint32_t index = 0; index < count; ++index) {
    const std::uint32_t port =
        kPortBase + kPortsPerDomain * config.domain_id + kFirstUnicastOffset + 2 * index;
    xml += "<Peer address=\"" + host + ":" + std::to_string(port) + "\"/>";
  }
  return xml;
}

std::string InterfacesXml(const BusConfig& config) {
  if (config.network == NetworkProfile::kLoopback) {
    return "<Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>";
  }
  if (config.interfaces.empty()) {
    return "";  // the library chooses
  }
  std::string xml = "<Interfaces>";
  for (const std::string& interface : config.interfaces) {
    xml += "<NetworkInterface ";
    xml += (IsAddress(interface) ? "address=\"" : "name=\"") + interface + "\"/>";
  }
  return xml + "</Interfaces>";
}

// Domains that this process is in. Never destroyed: buses may be static objects.
struct Registry {
  std::mutex mutex;
  std::map<std::uint32_t, std::weak_ptr<CycloneDomain>> domains;
};
Registry& TheRegistry() {
  static auto* registry = new Registry();  // NOLINT: see above
  return *registry;
}

}  // namespace

std::string DomainXml(const BusConfig& config) {
  const bool loopback = config.network == NetworkProfile::kLoopback;
  // "spdp": participants are announced by multicast, nothing else is. Readers that also take data
  // by multicast end processes on Fast DDS 2.9 that write to two of them (OutputTrafficManager, an
  // assertion of the library).
  const char* multicast = loopback ? "false" : "spdp";
  if (config.network == NetworkProfile::kWifi && !config.peers.empty()) {
    multicast = "false";
  }
  std::string peers;
  if (loopback) {
    peers += PeersXml(config, "127.0.0.1", kCalledOnThisHost);
  }
  for (const std::string& peer : config.peers) {
    peers += PeersXml(config, peer, kCalledOnOtherHosts);
  }
  if (!peers.empty()) {
    peers = "<Peers>" + peers + "</Peers>";
  }
  return "<CycloneDDS><Domain Id=\"any\"><General>" + InterfacesXml(config) + "<AllowMulticast>" +
         multicast +
         "</AllowMulticast>"
         // No message of ours is larger. Fast DDS 2.9 ends its process by an assertion now and then
         // when the writer of a fragmented message dies.
         "<MaxMessageSize>14720B</MaxMessageSize><FragmentSize>14000B</FragmentSize>"
         "</General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<MaxAutoParticipantIndex>" +
         std::to_string(kMaxParticipantIndex) + "</MaxAutoParticipantIndex><SPDPInterval>" +
         (loopback ? "200ms" : "2s") + "</SPDPInterval><LeaseDuration>10s</LeaseDuration>" + peers +
         "</Discovery><Internal>"
         // A slow reader must not hold a stream back: KEEP_LAST bounds what is kept, not bytes.
         "<Watermarks><WhcHigh>64 MB</WhcHigh><WhcHighInit>64 MB</WhcHighInit></Watermarks>"
         // The first request for acknowledgement that a secured participant sends is enciphered,
         // and the last message of the handshake may be packed behind it: Fast DDS 2.9, which
         // cannot decipher yet, then drops both, and neither library repeats the handshake. The
         // default of 10 ms passes before the handshake is over when cores are busy.
         "<PreEmptiveAckDelay>" +
         (config.security_dir.empty() ? "10 ms" : "2 s") +
         "</PreEmptiveAckDelay>"
         // What a reader misses it asks for this long after a heartbeat says so, and what came
         // later waits for it. The default of 100 ms is ten ticks without a pose, and longer than
         // the history of frames.
         "<NackDelay>2 ms</NackDelay>"
         // Fast DDS needs it to know whom a dispose means, see cyclone_sertype.cpp.
         "<GenerateKeyhash>true</GenerateKeyhash>"
         "<WriteBatch>" +
         (config.write_batching ? "true" : "false") + "</WriteBatch>" +
         (config.send_loss_permille > 0
              ? "<Test><XmitLossiness>" + std::to_string(config.send_loss_permille) +
                    "</XmitLossiness></Test>"
              : "") +
         "</Internal></Domain></CycloneDDS>";
}

Result<std::shared_ptr<CycloneDomain>> CycloneDomain::Join(const BusConfig& config) {
  QuietCycloneLog();
  Registry& registry = TheRegistry();
  const std::scoped_lock lock(registry.mutex);
  std::string xml = DomainXml(config);
  const std::string where = "bus.domain_id " + std::to_string(config.domain_id);
  if (auto joined = registry.domains[config.domain_id].lock(); joined != nullptr) {
    if (joined->xml_ != xml) {
      return Error{ErrorCode::kInvalidArgument,
                   where + " is in use by this process with another network, peers or batching"};
    }
    return joined;
  }
  const dds_entity_t entity = dds_create_domain(config.domain_id, xml.c_str());
  if (entity < 0) {
    const std::string why = LastCycloneError();
    return Error{ErrorCode::kUnavailable,
                 where + " cannot be joined: " + (why.empty() ? dds_strretcode(-entity) : why)};
  }
  std::shared_ptr<CycloneDomain> domain(new CycloneDomain(entity, std::move(xml)));
  registry.domains[config.domain_id] = domain;
  return domain;
}

CycloneDomain::~CycloneDomain() {
  // Under the lock, so that nobody joins while this process is still leaving.
  const std::scoped_lock lock(TheRegistry().mutex);
  dds_delete(entity_);
}

}  // namespace limbcast::bus::cyclone
