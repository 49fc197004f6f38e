// Makes a session, says who is in it, and ends it for everybody. Copy and change.
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "common/client/client.hpp"
#include "common/client/session_directory.hpp"

int main(int argc, char** argv) {
  using namespace limbcast;
  client::ClientOptions options;
  options.dds = argc > 1 ? argv[1] : "cyclone";
  if (argc > 2) options.domain_id = static_cast<std::uint32_t>(std::atoi(argv[2]));
  const std::string name = argc > 3 ? argv[3] : "stage";
  const int seconds = argc > 4 ? std::atoi(argv[4]) : 10;
  const auto fail = [](const Error& error) {
    std::fprintf(stderr, "limbcast-example-operator: %s\n", error.message.c_str());
    return 2;
  };

  const auto lobby = client::SessionDirectory::Connect(options);
  if (!lobby) return fail(lobby.error());
  if (const Status made = (*lobby)->Create(name); !made) return fail(made.error());

  options.session = name;
  options.role = roster::Role::kOperator;
  options.person = "director";
  const auto connected = client::Client::Connect(options);
  if (!connected) return fail(connected.error());
  client::Client& session = **connected;
  for (int second = 0; second < seconds; ++second) {
    std::this_thread::sleep_for(std::chrono::seconds(1));
    for (const BodyId body_id : session.Bodies()) {
      const auto entry = session.Entry(body_id);
      std::printf("body %u: %s\n", body_id.value, entry ? entry->person.c_str() : "nobody known");
    }
  }
  if (const Status closed = session.CloseSession(); !closed) return fail(closed.error());
  return EXIT_SUCCESS;
}
