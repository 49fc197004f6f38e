// Takes part in a session as a performer whose sensors a gateway brings, and sees itself. Copy and
// change.
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "common/client/client.hpp"

int main(int argc, char** argv) {
  using namespace limbcast;
  client::ClientOptions options;
  options.dds = argc > 1 ? argv[1] : "cyclone";
  if (argc > 2) options.domain_id = static_cast<std::uint32_t>(std::atoi(argv[2]));
  options.session = argc > 3 ? argv[3] : "stage";
  const int seconds = argc > 4 ? std::atoi(argv[4]) : 10;
  options.role = roster::Role::kPerformer;
  options.person = "Ada";
  options.sensors = {{MakeSensorUid("simulator", "sim-1-head"), body::Segment::kHead}};

  const auto connected = client::Client::Connect(options);
  if (!connected) {
    std::fprintf(stderr, "limbcast-example-performer: %s\n", connected.error().message.c_str());
    return 2;
  }
  client::Client& session = **connected;
  const BodyId me = session.Standing().body_id;
  std::printf("%s is body %u of session %s\n", options.person.c_str(), me.value,
              options.session.c_str());
  for (int second = 0; second < seconds; ++second) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const auto pose = session.PoseAt(me, session.Now());
    std::printf("%s\n", pose ? "seen" : "not seen yet: no fusion, posture or gateway");
  }
  return EXIT_SUCCESS;  // the client leaves the session as it goes
}
