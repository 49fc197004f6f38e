#include "tools/limbcast/doctor/diagnose.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
using bus::NetworkProfile;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A host on which all is well, and a gateway that reports.
DoctorFacts Healthy() {
  DoctorFacts facts;
  facts.config.domain_id = 7;
  facts.config.network = NetworkProfile::kLan;
  facts.network = "lan on eth0 10.0.0.5, peers by multicast";
  facts.host = {{.name = "lo", .address = "127.0.0.1", .up = true, .loopback = true},
                {.name = "eth0", .address = "10.0.0.5", .up = true, .multicast = true},
                {.name = "wlan0", .address = "10.1.0.5", .up = false, .multicast = true}};
  facts.listened_s = 4.0;
  facts.participants_here = 2;
  facts.receive_buffer_bytes = 4 * 1024 * 1024;
  facts.peers_matched = 3;
  facts.processes[1] = {.process_uid = 1,
                        .role = "gateway",
                        .host = "stage",
                        .pid = 17,
                        .last_error = {},
                        .reports = 4,
                        .smallest_age = 1ms};
  return facts;
}

DoctorFacts Alone() {
  DoctorFacts facts = Healthy();
  facts.processes.clear();
  facts.peers_matched = 0;
  return facts;
}

std::vector<std::string> IdsOf(const DoctorFacts& facts) {
  std::vector<std::string> ids;
  for (const Finding& finding : Diagnose(facts)) {
    EXPECT_FALSE(finding.text.empty() || finding.advice.empty()) << finding.id;
    EXPECT_EQ(ToText(finding).find('\n'), std::string::npos) << finding.id;
    ids.push_back(finding.id);
  }
  return ids;
}

std::string OnlyText(const DoctorFacts& facts) {
  const std::vector<Finding> findings = Diagnose(facts);
  EXPECT_EQ(findings.size(), 1U);
  return findings.empty() ? "" : ToText(findings.front());
}

TEST(DiagnoseTest, FindsNothingWhereNothingIsWrong) { EXPECT_THAT(IdsOf(Healthy()), IsEmpty()); }

TEST(DiagnoseTest, NoPeers) {
  EXPECT_THAT(
      OnlyText(Alone()),
      AllOf(HasSubstr("no_peers: nobody answered in domain 7 within 4.0 s"), HasSubstr("--peer")));
  DoctorFacts loopback = Alone();
  loopback.config.network = NetworkProfile::kLoopback;
  EXPECT_THAT(OnlyText(loopback), HasSubstr("loopback does not leave this host"));
}

TEST(DiagnoseTest, WrongInterface) {
  DoctorFacts facts = Healthy();
  facts.config.network = NetworkProfile::kInterfaces;
  facts.config.interfaces = {"usb0"};
  facts.refusal = "network interface 'usb0' does not exist";
  EXPECT_THAT(OnlyText(facts), AllOf(HasSubstr("wrong_interface: interface usb0 does not exist"),
                                     HasSubstr("name one of: eth0 10.0.0.5")));
  facts.config.interfaces = {"wlan0"};
  EXPECT_THAT(OnlyText(facts), HasSubstr("interface wlan0 10.1.0.5 is down"));
}

TEST(DiagnoseTest, APeerBehindAnInterfaceThatIsNotUsed) {
  DoctorFacts facts = Healthy();
  facts.probes = {{.peer = "studio", .address = "10.1.0.7", .leaves_by = "10.1.0.5", .refused = 8}};
  EXPECT_THAT(OnlyText(facts), AllOf(HasSubstr("the way to peer studio leaves by 10.1.0.5"),
                                     HasSubstr("--network 10.1.0.5")));
  facts.probes = {{.peer = "studio", .address = "10.1.0.7"}};
  EXPECT_THAT(OnlyText(facts), HasSubstr("no way from this host to peer studio (10.1.0.7)"));
  facts.probes = {{.peer = "studio"}};
  EXPECT_THAT(OnlyText(facts), HasSubstr("unknown_peer: no IPv4 address for peer studio"));
}

TEST(DiagnoseTest, BlockedPorts) {
  DoctorFacts facts = Alone();
  PeerProbe probe{.peer = "studio", .address = "10.0.0.7", .leaves_by = "10.0.0.5", .silent = 8};
  facts.probes = {probe};
  EXPECT_THAT(OnlyText(facts),
              AllOf(HasSubstr("blocked_ports: peer studio answers on none of 8 ports"),
                    HasSubstr("UDP ports 9150 to 9399")));
  probe = {.peer = "studio", .address = "10.0.0.7", .leaves_by = "10.0.0.5", .blocked = 8};
  facts.probes = {probe};
  EXPECT_THAT(OnlyText(facts), HasSubstr("a firewall refuses packets to peer studio (8 of 8"));
  // Its host says that nobody listens: nothing is blocked, nobody is there.
  probe = {.peer = "studio", .address = "10.0.0.7", .leaves_by = "10.0.0.5", .refused = 8};
  facts.probes = {probe};
  EXPECT_THAT(IdsOf(facts), ElementsAre("no_peers"));
}

TEST(DiagnoseTest, AnnouncementsWithoutAnythingElseAreBlockedPortsToo) {
  DoctorFacts facts = Alone();
  facts.announcements = {{"10.0.0.5", "Fast DDS"}};
  EXPECT_THAT(IdsOf(facts), ElementsAre("no_peers")) << "that is this host";
  facts.announcements.push_back({"10.0.0.9", "Cyclone DDS"});
  EXPECT_THAT(OnlyText(facts), AllOf(HasSubstr("blocked_ports: 10.0.0.9 (Cyclone DDS) announces"),
                                     HasSubstr("--security")));
  facts.peers_matched = 1;
  EXPECT_THAT(IdsOf(facts), IsEmpty());
}

TEST(DiagnoseTest, QosAndTypeMismatch) {
  DoctorFacts facts = Healthy();
  facts.mismatches = {{bus::BusEventKind::kIncompatibleQos, "skeleton", "LIVELINESS"},
                      {bus::BusEventKind::kTypeMismatch, "marg", "ours is A, a peer's B"}};
  EXPECT_THAT(IdsOf(facts), ElementsAre("qos_mismatch", "type_mismatch"));
  EXPECT_THAT(Diagnose(facts)[0].advice, HasSubstr("bus.stream_lease_s"));
  facts = Healthy();
  facts.processes[1].last_error = "bus: type_mismatch on marg (reader, count 1)";
  EXPECT_THAT(OnlyText(facts), HasSubstr("gateway 17 on stage says: bus: type_mismatch on marg"));
}

TEST(DiagnoseTest, ClockOffset) {
  DoctorFacts facts = Healthy();
  facts.processes[1].smallest_age = 320ms;
  EXPECT_THAT(OnlyText(facts),
              HasSubstr("clock_offset: the clock of stage is about 320 ms behind"));
  facts.processes[1].smallest_age = -8ms;
  EXPECT_THAT(OnlyText(facts), HasSubstr("8 ms ahead of ours"));
  facts.processes[2] = facts.processes[1];
  EXPECT_THAT(IdsOf(facts), ElementsAre("clock_offset")) << "one host, one line";
  facts.processes.erase(2);
  facts.processes[1].reports = 1;
  EXPECT_THAT(IdsOf(facts), IsEmpty()) << "the first report may have been kept for us";
}

TEST(DiagnoseTest, TwoSessionHosts) {
  DoctorFacts facts = Healthy();
  facts.processes[2] = {.process_uid = 2, .role = "session", .host = "a", .pid = 5};
  EXPECT_THAT(IdsOf(facts), IsEmpty());
  facts.processes[3] = {.process_uid = 3, .role = "session", .host = "b", .pid = 6};
  EXPECT_THAT(OnlyText(facts), HasSubstr("2 session hosts: pid 5 on a, pid 6 on b"));
}

TEST(DiagnoseTest, DuplicateSensors) {
  DoctorFacts facts = Healthy();
  facts.sensors[{1}] = {.serial = "00B42279", .wearers = {"\"Ada\" (body 1)", "\"Bob\" (body 2)"}};
  EXPECT_THAT(OnlyText(facts),
              HasSubstr("sensor 00B42279 is worn by \"Ada\" (body 1), \"Bob\" (body 2)"));
  facts.sensors[{1}] = {.wearers = {"\"Ada\" (body 1)"}, .samples = 400, .steps_back = 200};
  EXPECT_THAT(OnlyText(facts), HasSubstr("sensor 0000000000000001 comes from two sources"));
  facts.sensors[{1}].steps_back = 1;
  EXPECT_THAT(IdsOf(facts), IsEmpty()) << "a gateway was restarted";
}

TEST(DiagnoseTest, TooManyParticipants) {
  DoctorFacts facts = Healthy();
  facts.participants_here = 40;
  EXPECT_THAT(OnlyText(facts), HasSubstr("too_many_participants: 40 participants of domain 7"));
  facts.config.vendor = bus::Vendor::kFast;
  EXPECT_THAT(IdsOf(facts), IsEmpty());
  facts.participants_here = 64;
  facts.refusal = "no free port in domain 7";
  EXPECT_THAT(IdsOf(facts), ElementsAre("too_many_participants")) << "which explains the refusal";
}

TEST(DiagnoseTest, StaleSharedMemorySmallBuffersAndOldCredentials) {
  DoctorFacts facts = Healthy();
  facts.stale_shared_memory = {"fastrtps_1"};
  EXPECT_THAT(OnlyText(facts), HasSubstr("stale_shared_memory: 1 files"));
  facts = Healthy();
  facts.receive_buffer_bytes = 212992;
  EXPECT_THAT(OnlyText(facts), HasSubstr("small_socket_buffers: net.core.rmem_max is 212992"));
  facts = Healthy();
  facts.config.security_dir = "credentials";
  facts.credentials_left = 36h;
  EXPECT_THAT(OnlyText(facts),
              HasSubstr("credentials_expire: the credentials in credentials expire in 1.5 days"));
}

TEST(DiagnoseTest, ARefusalThatNothingExplainsIsTold) {
  DoctorFacts facts = Alone();
  facts.refusal = "Fast DDS refuses a participant in domain 7";
  EXPECT_THAT(OnlyText(facts), HasSubstr("network_refused: Fast DDS refuses"));
}

TEST(DiagnoseTest, JsonHasTheSame) {
  const DoctorFacts facts = Alone();
  const nlohmann::json json = ToJson(facts, Diagnose(facts));
  ASSERT_EQ(json.at("findings").size(), 1U);
  EXPECT_EQ(json.at("findings")[0].at("id"), "no_peers");
  EXPECT_EQ(json.at("processes"), 0);
  EXPECT_EQ(json.at("network"), facts.network);
}

}  // namespace
}  // namespace limbcast::tool
