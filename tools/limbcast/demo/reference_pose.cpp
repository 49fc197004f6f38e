#include "tools/limbcast/demo/reference_pose.hpp"

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

namespace limbcast::tool {

namespace {
constexpr Duration kPause = std::chrono::milliseconds(300);
}  // namespace

Result<std::unique_ptr<ReferencePose>> ReferencePose::Make(bus::Bus& bus) {
  std::unique_ptr<ReferencePose> made(new ReferencePose);
  std::random_device random;
  made->client_uid_ = (std::uint64_t{random()} << 32U) | random();
  auto writer = bus.MakeWriter<roster::Command>();
  if (!writer) {
    return writer.error();
  }
  made->writer_ = std::move(*writer);
  auto reader = bus.MakeReader<roster::CommandReply>(
      {.on_sample =
           [self = made.get()](const roster::CommandReply& reply, const bus::SampleInfo&) {
             if (reply.client_uid == self->client_uid_) {
               const std::lock_guard lock(self->mutex_);
               self->message_ = reply.message;
               const auto request = self->requests_.find(reply.request_id);
               if (request != self->requests_.end()) {
                 Asked& asked = self->bodies_[request->second];
                 asked.accepted = asked.accepted || reply.accepted;
                 self->requests_.erase(request);
               }
             }
           },
       .on_disposed = {}});
  if (!reader) {
    return reader.error();
  }
  made->reader_ = std::move(*reader);
  return made;
}

void ReferencePose::Ask(BodyId body_id, Time now) {
  roster::Command command;
  {
    const std::lock_guard lock(mutex_);
    Asked& asked = bodies_[body_id];
    if (asked.accepted || now - asked.at < kPause) {
      return;
    }
    asked.at = now;
    command.request_id = ++request_id_;
    requests_[command.request_id] = body_id;
  }
  command.client_uid = client_uid_;
  command.body_id = body_id;
  command.kind = roster::CommandKind::kReferencePose;
  if (const Status written = writer_->Write(command); !written) {
    const std::lock_guard lock(mutex_);
    message_ = written.error().message;
  }
  writer_->Flush();
}

bool ReferencePose::accepted() {
  const std::lock_guard lock(mutex_);
  return !bodies_.empty() && std::all_of(bodies_.begin(), bodies_.end(),
                                         [](const auto& body) { return body.second.accepted; });
}

std::string ReferencePose::message() {
  const std::lock_guard lock(mutex_);
  return message_;
}

}  // namespace limbcast::tool
