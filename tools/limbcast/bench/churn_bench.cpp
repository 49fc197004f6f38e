#include "tools/limbcast/bench/churn_bench.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <system_error>
#include <utility>

#include "common/client/client.hpp"
#include "common/client/session_directory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "tools/process/child_process.hpp"

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

constexpr const char* kSession = "churn";
constexpr Duration kPatience = 60s;  // for what takes a moment on a quiet machine
constexpr Duration kLook = 20ms;
constexpr std::array<const char*, 3> kServices = {"session", "fusion", "posture"};

double SecondsSince(SteadyClock::time_point then) {
  return std::chrono::duration<double>(SteadyClock::now() - then).count();
}

class Churn {
 public:
  explicit Churn(const ChurnOptions& options)
      : options_(options), people_(static_cast<std::size_t>(options.people)) {
    random_.seed(options.seed);
    std::string name = (std::filesystem::temp_directory_path() / "limbcast-churn-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) {
      state_dir_ = name;
    }
    for (std::size_t i = 0; i < people_.size(); ++i) {
      people_[i].name = fmt::format("P{}", i + 1);
    }
  }
  ~Churn() {
    std::error_code error;
    if (!state_dir_.empty()) {
      std::filesystem::remove_all(state_dir_, error);
    }
  }
  Churn(const Churn&) = delete;
  Churn& operator=(const Churn&) = delete;

  Result<nlohmann::json> Run() {
    if (const Status up = Begin(); !up) {
      return up.error();
    }
    fmt::print("{}", ChurnHeading());
    begun_ = SteadyClock::now();
    Count();  // what it takes with people who came and left once
    const double end_s = 60.0 * options_.minutes;
    while (!stop_.Requested() && SecondsSince(begun_) < end_s) {
      Mix(std::min(end_s, SecondsSince(begun_) + options_.count_every_s));
      if (!stop_.Requested()) {
        Count();
      }
    }
    End();
    nlohmann::json report = ChurnJson(counts_, events_, options_.limits);
    fmt::print("{}", ChurnText(report));
    return report;
  }

 private:
  struct Person {
    std::string name;
    std::optional<process::ChildProcess> gateway;
    BodyId body_id;  // the first one; it must stay
  };

  [[nodiscard]] std::vector<std::string> Arguments(const std::string& program) const {
    return {fmt::format("{}/limbcast-{}", options_.folder, program),
            "--dds",
            std::string(VendorOf(options_.dds, program)),
            "--domain",
            std::to_string(options_.bus.domain_id),
            "--log-level",
            "error"};
  }

  Status StartService(const std::string& name) {
    std::vector<std::string> arguments = Arguments(name);
    const auto add = [&](std::initializer_list<std::string> more) {
      arguments.insert(arguments.end(), more);
    };
    if (name == "session") {
      add({"--set", "session.state_dir=" + state_dir_ + "/session", "--set", "session.lease_s=1",
           "--set", "session.grace_s=2", "--set",
           fmt::format("session.sessions=[\"{}\"]", kSession)});
    } else {
      add({"--partition", kSession});
    }
    if (name == "posture") {
      add({"--set", "posture.state_dir=" + state_dir_ + "/posture"});
    }
    auto started = process::ChildProcess::Start({.arguments = arguments});
    if (!started) {
      return started.error();
    }
    services_.insert_or_assign(name, std::move(*started));
    return Ok();
  }

  void NoteFailure(const std::string& who, const process::ExitState& ended,
                   const process::ChildProcess& process) {
    events_.failures.push_back(fmt::format("{}: status {}, signal {}: {}", who, ended.status,
                                           ended.signal, process.Errors()));
  }

  // Starts it again at once.
  void Restart(const std::string& service) {
    if (const Status again = StartService(service); !again) {
      events_.failures.push_back(again.error().message);
    }
  }

  static void Kill(process::ChildProcess& process) {
    process.Signal(SIGKILL);
    (void)process.Stop(5s);
  }

  void StartPerson(Person& person) {
    std::vector<std::string> arguments = Arguments("gateway");
    for (const std::string& setting :
         {std::string("gateway.session_host=true"), fmt::format("gateway.session={}", kSession),
          "gateway.person=" + person.name, "simulator.serial_prefix=" + person.name,
          std::string("simulator.sensors=reduced15"), std::string("gateway.publish_truth=false"),
          std::string("gateway.marg_frame=true")}) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    arguments.insert(arguments.end(), {"--partition", kSession});
    auto started = process::ChildProcess::Start({.arguments = arguments});
    if (!started) {
      events_.failures.push_back(started.error().message);
      return;
    }
    person.gateway = std::move(*started);
    ++events_.joined;
  }

  void StopPerson(Person& person) {
    const process::ExitState ended = person.gateway->Stop(10s);
    // One that was asked before it could listen dies of the asking.
    if (!ended.clean() && ended.signal != SIGTERM) {
      NoteFailure("gateway of " + person.name, ended, *person.gateway);
    }
    person.gateway.reset();
    ++events_.left;
  }

  Result<std::unique_ptr<client::Client>> Spectator(const std::string& name) const {
    client::ClientOptions options;
    options.dds = std::string(VendorOf(options_.dds, "client"));
    options.domain_id = options_.bus.domain_id;
    options.session = kSession;
    options.person = name;
    options.join_timeout = kPatience;
    return client::Client::Connect(options);
  }

  Status Begin() {
    if (state_dir_.empty()) {
      return Error{ErrorCode::kUnavailable, "no temporary folder can be made"};
    }
    for (const char* name : kServices) {
      if (Status started = StartService(name); !started) {
        return started;
      }
    }
    auto watcher = Spectator("watcher");
    if (!watcher) {
      return watcher.error();
    }
    watcher_ = std::move(*watcher);
    return Ok();
  }

  // Nobody may end but by our own hand.
  void LookAfterProcesses() {
    for (auto& [name, service] : services_) {
      if (const auto ended = service.Poll()) {
        NoteFailure(name, *ended, service);
        Restart(name);
        return;
      }
    }
    for (Person& person : people_) {
      if (!person.gateway) {
        continue;
      }
      if (const auto ended = person.gateway->Poll()) {
        NoteFailure("gateway of " + person.name, *ended, *person.gateway);
        person.gateway.reset();
      }
    }
  }

  void KillService() {
    const std::string name = kServices[std::uniform_int_distribution<std::size_t>(0, 2)(random_)];
    Kill(services_.at(name));
    ++events_.killed[name];
    Restart(name);
  }

  void MovePerson() {
    Person& person =
        people_[std::uniform_int_distribution<std::size_t>(0, people_.size() - 1)(random_)];
    if (!person.gateway) {
      StartPerson(person);
    } else if (std::bernoulli_distribution(0.3)(random_)) {
      Kill(*person.gateway);
      person.gateway.reset();
      ++events_.vanished;
    } else {
      StopPerson(person);
    }
  }

  void MoveSpectator() {
    if (guest_) {
      guest_.reset();
      ++events_.spectators;
      return;
    }
    auto guest = Spectator("guest");
    if (guest) {
      guest_ = std::move(*guest);
    } else {
      events_.failures.push_back("guest: " + guest.error().message);
    }
  }

  void Mix(double until_s) {
    std::exponential_distribution<double> pause_s(1.0 / options_.action_every_s);
    while (SecondsSince(begun_) < until_s) {
      if (stop_.WaitFor(DurationFromSeconds(
              std::min(pause_s(random_), std::max(0.0, until_s - SecondsSince(begun_)))))) {
        return;
      }
      LookAfterProcesses();
      const double what = std::uniform_real_distribution<double>(0.0, 1.0)(random_);
      if (what < 0.7) {
        MovePerson();
      } else if (what < 0.85) {
        MoveSpectator();
      } else {
        KillService();
      }
    }
  }

  template <typename Condition>
  bool Eventually(Condition condition) {
    const auto begun = SteadyClock::now();
    while (!condition()) {
      if (SteadyClock::now() - begun > kPatience || stop_.WaitFor(kLook)) {
        return false;
      }
      LookAfterProcesses();
    }
    return true;
  }

  // Bodies that have a skeleton of now, by the name of their person.
  [[nodiscard]] std::map<std::string, BodyId> Moving() const {
    std::map<std::string, BodyId> moving;
    for (const BodyId body_id : watcher_->Bodies()) {
      const auto skeleton = watcher_->Latest(body_id);
      const auto entry = watcher_->Entry(body_id);
      if (skeleton && entry && watcher_->Now() - skeleton->measured_at < 500ms) {
        moving.emplace(entry->person, body_id);
      }
    }
    return moving;
  }

  double BringEverybody() {
    for (Person& person : people_) {
      if (!person.gateway) {
        StartPerson(person);
      }
    }
    const auto begun = SteadyClock::now();
    if (!Eventually([&] { return Moving().size() == people_.size(); })) {
      return -1.0;
    }
    const double took_s = SecondsSince(begun);
    const std::map<std::string, BodyId> moving = Moving();
    for (Person& person : people_) {
      const auto found = moving.find(person.name);
      if (found == moving.end()) {
        continue;
      }
      if (person.body_id == BodyId{}) {
        person.body_id = found->second;
      } else if (person.body_id != found->second) {
        events_.failures.push_back(fmt::format("{} was body {} and is body {}", person.name,
                                               person.body_id.value, found->second.value));
      }
    }
    return took_s;
  }

  void SendEverybodyHome() {
    for (Person& person : people_) {
      if (person.gateway) {
        StopPerson(person);
      }
    }
    guest_.reset();
  }

  ChurnCount Take(double all_there_s) const {
    ChurnCount count;
    count.at_s = SecondsSince(begun_);
    count.all_there_s = all_there_s;
    for (const auto& [name, service] : services_) {
      if (const auto is = process::CountOf(service.pid())) {
        count.processes.emplace(name, *is);
      }
    }
    if (const auto is = process::CountOf(getpid())) {
      count.processes.emplace("client", *is);
    }
    count.shared_memory_files = process::FilesIn("/dev/shm");
    for (const BodyId body_id : watcher_->Bodies()) {
      count.people.push_back(fmt::format("body {}", body_id.value));
    }
    for (const Person& person : people_) {
      if (watcher_->Entry(person.body_id)) {
        count.people.push_back(
            fmt::format("{} in the roster as body {}", person.name, person.body_id.value));
      }
    }
    return count;
  }

  void Count() {
    const double all_there_s = BringEverybody();
    SendEverybodyHome();
    // What is given back late is no leak; what is never given back is.
    (void)Eventually([&] {
      const ChurnCount now = Take(all_there_s);
      return now.people.empty() &&
             (counts_.empty() || LeakOf(counts_.front(), now, options_.limits).empty());
    });
    counts_.push_back(Take(all_there_s));
    fmt::print("{}", ChurnRow(counts_.front(), counts_.back(), options_.limits));
    std::fflush(stdout);
  }

  void End() {
    SendEverybodyHome();
    watcher_.reset();
    for (auto& [name, service] : services_) {
      const process::ExitState ended = service.Stop(10s);
      if (!ended.clean()) {
        NoteFailure(name + " at the end", ended, service);
      }
    }
  }

  const ChurnOptions& options_;
  runtime::StopSignal stop_;
  std::mt19937_64 random_;
  std::string state_dir_;
  std::map<std::string, process::ChildProcess> services_;
  std::vector<Person> people_;
  std::unique_ptr<client::Client> watcher_;
  std::unique_ptr<client::Client> guest_;
  SteadyClock::time_point begun_{};
  std::vector<ChurnCount> counts_;
  ChurnEvents events_;
};

}  // namespace

Result<nlohmann::json> BenchChurn(const ChurnOptions& options) { return Churn(options).Run(); }

}  // namespace limbcast::tool
