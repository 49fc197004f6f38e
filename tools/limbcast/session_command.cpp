#include "tools/limbcast/session_command.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/client/client.hpp"
#include "common/client/session_directory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "tools/limbcast/live_bus.hpp"

namespace limbcast::tool {
namespace {

using roster::Role;

struct SessionOptions {
  std::string session;
  std::string person = "guest";
  std::string role = "spectator";
  std::vector<std::string> wear;  // SEGMENT=DRIVER:SERIAL
  double seconds = 0.0;           // 0 = until Ctrl-C
  double timeout_s = 5.0;
};

Result<Role> ParseRole(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, Role>, 3> kRoles = {
      {{"performer", Role::kPerformer},
       {"spectator", Role::kSpectator},
       {"operator", Role::kOperator}}};
  for (const auto& [name, role] : kRoles) {
    if (text == name) {
      return role;
    }
  }
  return Error{ErrorCode::kInvalidArgument,
               "--role must be performer, spectator or operator, is \"" + text + '"'};
}

Result<roster::SensorAssignment> ParseWear(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.find(':', equals == std::string::npos ? 0 : equals);
  const auto segment = body::ParseSegment(text.substr(0, equals));
  if (!segment || equals == std::string::npos || colon == std::string::npos) {
    return Error{ErrorCode::kInvalidArgument,
                 "--wear must be SEGMENT=DRIVER:SERIAL, is \"" + text + '"'};
  }
  return roster::SensorAssignment{
      .sensor_uid =
          MakeSensorUid(text.substr(equals + 1, colon - equals - 1), text.substr(colon + 1)),
      .segment = *segment};
}

// The directory of sessions on a network of its own.
struct OpenDirectory {
  std::unique_ptr<bus::Bus> bus;  // outlives the directory
  std::unique_ptr<client::SessionDirectory> directory;
};

Result<OpenDirectory> Open(const service::ServiceCommandLine& line) {
  auto bus = OpenLiveBus(line);
  if (!bus) {
    return bus.error();
  }
  auto directory = client::SessionDirectory::Attach(**bus);
  if (!directory) {
    return directory.error();
  }
  return OpenDirectory{std::move(*bus), std::move(*directory)};
}

int List(const service::ServiceCommandLine& line, const SessionOptions& options) {
  const auto open = Open(line);
  if (!open) {
    return line.Fail(open.error());
  }
  const auto sessions = open->directory->List(DurationFromSeconds(options.timeout_s));
  if (!sessions) {
    return line.Fail(sessions.error());
  }
  fmt::print("{:24} {:>6} {:>10}\n", "session", "people", "joinable");
  for (const roster::SessionState& session : *sessions) {
    fmt::print("{:24} {:6} {:>10}\n", session.name, session.performer_count,
               session.open ? "yes" : "full");
  }
  return 0;
}

int Create(const service::ServiceCommandLine& line, const SessionOptions& options) {
  const auto open = Open(line);
  if (!open) {
    return line.Fail(open.error());
  }
  const Status created =
      open->directory->Create(options.session, DurationFromSeconds(options.timeout_s));
  return created ? 0 : line.Fail(created.error());
}

// A member of the session for as long as `then` takes.
template <typename Then>
int AsMember(const service::ServiceCommandLine& line, const SessionOptions& options, Role role,
             Then then) {
  const runtime::SystemClock clock;
  client::ClientOptions as;
  as.session = options.session;
  as.person = options.person;
  as.role = role;
  as.join_timeout = DurationFromSeconds(options.timeout_s);
  for (const std::string& text : options.wear) {
    const auto sensor = ParseWear(text);
    if (!sensor) {
      return line.Fail(sensor.error());
    }
    as.sensors.push_back(*sensor);
  }
  const auto bus = OpenLiveBus(line, options.session);
  if (!bus) {
    return line.Fail(bus.error());
  }
  const auto joined = client::Client::Attach(**bus, clock, as);
  if (!joined) {
    return line.Fail(joined.error());
  }
  const Status done = then(**joined);
  return done ? 0 : line.Fail(done.error());
}

int Join(const service::ServiceCommandLine& line, const SessionOptions& options) {
  const auto role = ParseRole(options.role);
  if (!role) {
    return line.Fail(role.error());
  }
  const runtime::StopSignal stop;  // Ctrl-C leaves in good order
  return AsMember(line, options, *role, [&](client::Client& member) {
    const BodyId body = member.Standing().body_id;
    fmt::print("in session \"{}\" as {} \"{}\"{}\n", options.session, options.role, options.person,
               body.value == 0 ? "" : fmt::format(", body {}", body.value));
    std::fflush(stdout);
    member.OnStanding([](const client::SessionStanding& standing) {
      fmt::print("{}\n", standing.member ? "in the session again" : standing.message);
      std::fflush(stdout);
    });
    if (options.seconds > 0.0) {
      stop.WaitFor(DurationFromSeconds(options.seconds));
    } else {
      stop.Wait();
    }
    member.OnStanding({});
    return Ok();
  });
}

int Leave(const service::ServiceCommandLine& line, const SessionOptions& options) {
  SessionOptions as = options;
  as.person = "limbcast session leave";
  return AsMember(line, as, Role::kOperator, [&](client::Client& member) {
    return member.ReleasePerson(options.person, DurationFromSeconds(options.timeout_s));
  });
}

int Close(const service::ServiceCommandLine& line, const SessionOptions& options) {
  SessionOptions as = options;
  as.person = "limbcast session close";
  return AsMember(line, as, Role::kOperator, [&](client::Client& member) {
    return member.CloseSession(DurationFromSeconds(options.timeout_s));
  });
}

}  // namespace

SubCommand AddSessionCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<SessionOptions>();
  CLI::App* app = line.app().add_subcommand(
      "session",
      "Sessions of a running limbcast-session: groups of people, each in a partition of its own.\n"
      "Examples:\n  limbcast session create stage\n  limbcast session list\n"
      "  limbcast session join stage --person Ada --role performer --wear pelvis=simulator:s1\n"
      "  limbcast session leave stage Ada       an operator sends Ada away\n"
      "  limbcast session close stage");
  app->require_subcommand(1);
  app->fallthrough();
  app->add_option("--timeout", options->timeout_s, "Seconds to wait for the session host")
      ->check(CLI::Range(0.1, 600.0));
  const auto named = [&](const char* word, const char* what) {
    CLI::App* sub = app->add_subcommand(word, what);
    sub->fallthrough();
    sub->add_option("session", options->session, "Name of the session")->required();
    return sub;
  };
  CLI::App* list = app->add_subcommand("list", "The sessions that there are");
  list->fallthrough();
  CLI::App* create = named("create", "Make a session");
  CLI::App* join = named("join", "Take part until Ctrl-C, or for --seconds");
  join->add_option("--person", options->person, "Who");
  join->add_option("--role", options->role, "performer, spectator or operator");
  join->add_option("--wear", options->wear, "A performer's sensor: SEGMENT=DRIVER:SERIAL")
      ->allow_extra_args(false);
  join->add_option("--seconds", options->seconds, "How long; 0 = until Ctrl-C");
  CLI::App* leave = named("leave", "Send a person away, as an operator");
  leave->add_option("person", options->person, "Who")->required();
  named("close", "End a session for everybody, as an operator");
  return {.app = app, .run = [&line, options, list, create, join, leave] {
            return list->parsed()     ? List(line, *options)
                   : create->parsed() ? Create(line, *options)
                   : join->parsed()   ? Join(line, *options)
                   : leave->parsed()  ? Leave(line, *options)
                                      : Close(line, *options);
          }};
}

}  // namespace limbcast::tool
