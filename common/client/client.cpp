#include "common/client/client.hpp"

#include <chrono>
#include <utility>

#include "common/body/default_body.hpp"
#include "common/client/client_impl.hpp"
#include "common/client/network.hpp"

namespace limbcast::client {
namespace {

class SystemClock final : public Clock {
 public:
  [[nodiscard]] Time Now() const override {
    return Time(
        std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()));
  }
};

Status Validate(const ClientOptions& options) {
  if (options.history < 2 || options.history > 4096) {
    return Error{ErrorCode::kInvalidArgument, "client history must be in [2, 4096] skeletons, is " +
                                                  std::to_string(options.history)};
  }
  if (options.max_prediction < Duration::zero() ||
      options.max_prediction > std::chrono::seconds(1)) {
    return Error{ErrorCode::kInvalidArgument,
                 "client max_prediction must be in [0, 1] s, is " +
                     std::to_string(ToSeconds(options.max_prediction))};
  }
  return Ok();
}

}  // namespace

Status Client::Impl::Join(bus::Bus& bus) {
  bus_ = &bus;
  const bool only_listens = OnlyListens(options_);
  if (!only_listens) {
    auto commands = Requester<roster::Command, roster::CommandReply>::Make(bus, DrawClientUid());
    if (!commands) {
      return commands.error();
    }
    commands_ = std::move(*commands);
  }
  auto entries = bus.MakeReader<roster::RosterEntry>(
      {.on_sample = [this](const auto& entry, const bus::SampleInfo&) { Take(entry); },
       .on_disposed = [this](const auto& key) { Leave(key.body_id); }});
  if (!entries) {
    return entries.error();
  }
  auto definitions = bus.MakeReader<body::BodyDefinition>(
      {.on_sample = [this](const auto& definition, const bus::SampleInfo&) { Take(definition); },
       .on_disposed = [this](const auto& key) { Remove(key); }});
  if (!definitions) {
    return definitions.error();
  }
  auto skeletons = bus.MakeReader<body::Skeleton>(
      {.on_sample = [this](const auto& skeleton, const bus::SampleInfo&) { Take(skeleton); },
       .on_disposed = {}});
  if (!skeletons) {
    return skeletons.error();
  }
  entries_ = std::move(*entries);
  definitions_ = std::move(*definitions);
  skeletons_ = std::move(*skeletons);
  return options_.session.empty() || only_listens ? Ok() : JoinSession(bus);
}

Status Client::Impl::JoinSession(bus::Bus& bus) {
  auto member = SessionMember::Make(
      bus, options_.session,
      {{.role = options_.role, .person = options_.person, .sensors = options_.sensors}},
      [this](std::size_t, const MemberStatus& status) { Take(status); });
  if (!member) {
    return member.error();
  }
  member_ = std::move(*member);
  member_->Start();
  return member_->WaitUntilJoined(options_.join_timeout);
}

void Client::Impl::Take(const MemberStatus& status) {
  const std::scoped_lock lock(callback_mutex_);
  if (on_standing_) {
    on_standing_(StandingOf(status));
  }
}

Status Client::Impl::AskHost(roster::CommandKind kind, const std::string& text, Duration timeout) {
  if (member_ == nullptr) {
    return Error{ErrorCode::kInvalidArgument, "the client is in no session"};
  }
  const auto reply = member_->Ask(kind, text, timeout);
  if (!reply) {
    return Error{reply.error().code,
                 "session host of \"" + options_.session + "\": " + reply.error().message};
  }
  return reply->accepted ? Ok() : Error{ErrorCode::kInvalidArgument, reply->message};
}

void Client::Impl::Take(const body::Skeleton& skeleton) {
  {
    const std::scoped_lock lock(mutex_);
    Of(skeleton.body_id).skeletons.Add(skeleton);
  }
  const std::scoped_lock lock(callback_mutex_);
  if (on_skeleton_) {
    on_skeleton_(skeleton);
  }
}

void Client::Impl::Take(const body::BodyDefinition& definition) {
  {
    const std::scoped_lock lock(mutex_);
    Person& person = Of(definition.body_id);
    person.definition = definition;
    person.kinematics.reset();
    if (body::Validate(definition)) {
      person.kinematics.emplace(definition);
    }
    changed_.notify_all();
    if (person.left) {
      return;
    }
  }
  Tell(definition, true);
}

void Client::Impl::Remove(const body::BodyDefinition& key) {
  body::BodyDefinition gone;
  gone.body_id = key.body_id;
  {
    const std::scoped_lock lock(mutex_);
    const Person* person = Find(key.body_id);
    const bool was_there = person != nullptr;
    gone = was_there ? person->definition.value_or(gone) : gone;
    people_.erase(key.body_id);
    if (!was_there) {
      return;
    }
  }
  Tell(gone, false);
}

void Client::Impl::Take(const roster::RosterEntry& entry) {
  body::BodyDefinition back;
  {
    const std::scoped_lock lock(mutex_);
    roster_[entry.body_id] = entry;
    const auto found = people_.find(entry.body_id);
    if (found == people_.end() || !found->second.left) {
      return;
    }
    Person& person = found->second;
    if (!person.definition || person.definition->name != entry.person) {
      people_.erase(found);  // of the one who had this body before
      return;
    }
    person.left = false;
    back = *person.definition;
    changed_.notify_all();
  }
  Tell(back, true);
}

void Client::Impl::Leave(BodyId body_id) {
  body::BodyDefinition gone;
  {
    const std::scoped_lock lock(mutex_);
    roster_.erase(body_id);
    const auto found = people_.find(body_id);
    if (found == people_.end() || found->second.left) {
      return;
    }
    Person& person = found->second;
    person.left = true;
    person.skeletons = SkeletonHistory(options_.history);
    if (!person.definition) {
      return;
    }
    gone = *person.definition;
  }
  Tell(gone, false);
}

void Client::Impl::Tell(const body::BodyDefinition& definition, bool present) {
  const std::scoped_lock lock(callback_mutex_);
  if (on_body_) {
    on_body_(definition, present);
  }
}

std::vector<BodyId> Client::Impl::Bodies() const {
  const std::scoped_lock lock(mutex_);
  std::vector<BodyId> bodies;
  for (const auto& [body_id, person] : people_) {
    if (person.definition && !person.left) {
      bodies.push_back(body_id);
    }
  }
  return bodies;
}

std::optional<body::BodyDefinition> Client::Impl::Definition(BodyId body_id) const {
  const std::scoped_lock lock(mutex_);
  const Person* person = Find(body_id);
  return person == nullptr ? std::nullopt : person->definition;
}

std::optional<body::Skeleton> Client::Impl::Latest(BodyId body_id) const {
  const std::scoped_lock lock(mutex_);
  const Person* person = Find(body_id);
  if (person == nullptr || person->skeletons.empty()) {
    return std::nullopt;
  }
  return person->skeletons.latest();
}

std::optional<Pose> Client::Impl::PoseAt(BodyId body_id, Time at) const {
  const std::scoped_lock lock(mutex_);
  const Person* person = Find(body_id);
  if (person == nullptr || person->skeletons.empty()) {
    return std::nullopt;
  }
  const bool same_definition =
      person->kinematics &&
      person->definition->revision == person->skeletons.latest().definition_revision;
  return person->skeletons.At(at, options_.max_prediction,
                              same_definition ? &*person->kinematics : nullptr);
}

Result<roster::CommandReply> Client::Impl::Send(roster::Command command, Duration timeout) {
  if (commands_ == nullptr) {
    return Error{ErrorCode::kInvalidArgument,
                 "a spectator of a secured network publishes nothing, no command either"};
  }
  const auto until = std::chrono::steady_clock::now() + timeout;
  {
    // First see the person whom a service speaks for: then the service itself is found, too.
    std::unique_lock lock(mutex_);
    const bool known = changed_.wait_until(lock, until, [&] {
      const Person* person = Find(command.body_id);
      return person != nullptr && person->definition.has_value();
    });
    if (!known) {
      return Error{ErrorCode::kNotFound,
                   "no body " + std::to_string(command.body_id.value) + " is published"};
    }
  }
  auto reply = commands_->Ask(std::move(command), until);
  if (!reply && reply.error().code == ErrorCode::kUnavailable) {
    return Error{ErrorCode::kUnavailable, "no service listens to commands on " + bus_->Describe()};
  }
  if (!reply && reply.error().code == ErrorCode::kTimeout) {
    return Error{ErrorCode::kTimeout,
                 "no answer to the command within " + std::to_string(ToSeconds(timeout)) + " s"};
  }
  return reply;
}

Client::Client(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Client::~Client() = default;

Result<std::unique_ptr<Client>> Client::Connect(const ClientOptions& options) {
  if (const Status valid = Validate(options); !valid) {
    return valid.error();
  }
  auto bus = OpenNetwork(options);
  if (!bus) {
    return bus.error();
  }
  auto impl = std::make_unique<Impl>(std::make_unique<SystemClock>(), nullptr, options);
  bus::Bus& joined = **bus;
  impl->Own(std::move(*bus));
  if (const Status status = impl->Join(joined); !status) {
    return status.error();
  }
  return std::unique_ptr<Client>(new Client(std::move(impl)));
}

Result<std::unique_ptr<Client>> Client::Attach(bus::Bus& bus, const Clock& clock,
                                               const ClientOptions& options) {
  if (const Status valid = Validate(options); !valid) {
    return valid.error();
  }
  auto impl = std::make_unique<Impl>(nullptr, &clock, options);
  if (const Status status = impl->Join(bus); !status) {
    return status.error();
  }
  return std::unique_ptr<Client>(new Client(std::move(impl)));
}

Time Client::Now() const { return impl_->clock().Now(); }
std::vector<BodyId> Client::Bodies() const { return impl_->Bodies(); }
std::optional<body::BodyDefinition> Client::Definition(BodyId body_id) const {
  return impl_->Definition(body_id);
}
std::optional<roster::RosterEntry> Client::Entry(BodyId body_id) const {
  return impl_->Entry(body_id);
}
SessionStanding Client::Standing() const { return impl_->Standing(); }
void Client::OnStanding(std::function<void(const SessionStanding&)> callback) {
  impl_->OnStanding(std::move(callback));
}
Status Client::ReleasePerson(const std::string& person, Duration timeout) {
  return impl_->AskHost(roster::CommandKind::kReleasePerson, person, timeout);
}
Status Client::CloseSession(Duration timeout) {
  return impl_->AskHost(roster::CommandKind::kCloseSession, "", timeout);
}
std::optional<body::Skeleton> Client::Latest(BodyId body_id) const {
  return impl_->Latest(body_id);
}
std::optional<Pose> Client::PoseAt(BodyId body_id, Time display_time) const {
  return impl_->PoseAt(body_id, display_time);
}
void Client::OnSkeleton(std::function<void(const body::Skeleton&)> callback) {
  impl_->OnSkeleton(std::move(callback));
}
void Client::OnBody(std::function<void(const body::BodyDefinition&, bool)> callback) {
  impl_->OnBody(std::move(callback));
}
Result<roster::CommandReply> Client::Send(roster::CommandKind kind, BodyId body_id,
                                          const std::string& text,
                                          const std::vector<double>& numbers, Duration timeout) {
  roster::Command command;
  command.body_id = body_id;
  command.kind = kind;
  command.text = text;
  command.numbers = numbers;
  return impl_->Send(std::move(command), timeout);
}
std::string Client::Describe() const { return impl_->Describe(); }

}  // namespace limbcast::client
