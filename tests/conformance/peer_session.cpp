#include "tests/conformance/peer_session.hpp"

#include <chrono>
#include <sstream>
#include <utility>

#include "common/bus/bus_factory.hpp"

namespace limbcast::conformance {
namespace {

using std::chrono::microseconds;
using std::chrono::steady_clock;

std::uint32_t Number(const std::string& text) {
  return static_cast<std::uint32_t>(std::stoul(text));
}

// Writes one round of keys; the first refusal wins.
Status WriteRound(TopicWriter& writer, std::uint32_t first_key, std::uint32_t keys,
                  std::uint32_t sequence) {
  for (std::uint32_t key = first_key; key < first_key + keys; ++key) {
    if (Status written = writer.Write(key, sequence); !written) {
      return written;
    }
  }
  return Ok();
}

}  // namespace

PeerSession::~PeerSession() { Close(); }

std::string PeerSession::Do(const std::string& line) {
  std::istringstream in(line);
  Words words;
  for (std::string word; in >> word;) {
    words.push_back(word);
  }
  if (words.empty()) {
    return "error empty line";
  }
  const Result<std::string> reply = Dispatch(words);
  return reply ? "ok " + *reply : "error " + reply.error().message;
}

Result<std::string> PeerSession::Dispatch(const Words& words) {
  const std::string& verb = words[0];
  if (verb == "open" && words.size() == 8) {
    return Open(words);
  }
  if (verb == "write" && words.size() == 7) {
    return Write(words);
  }
  if (verb == "start" && words.size() == 6) {
    return Start(words);
  }
  if (verb == "stop" && words.size() == 2) {
    return Stop(words[1]);
  }
  if (verb == "garbage" && words.size() == 2) {
    return SendGarbage(words[1], Garbage(words[1]));
  }
  if (verb == "encapsulations" && words.size() == 2) {
    return SendGarbage(words[1], BadEncapsulations(words[1]));
  }
  if (verb == "counters" && words.size() == 2) {
    return Counters(words[1]);
  }
  if (verb == "events") {
    return Events();
  }
  if (verb == "close") {
    Close();
    return std::string();
  }
  if (verb == "drop" && words.size() == 2) {
    writers_.erase(words[1]);
    return std::string();
  }
  if ((verb == "writer" && words.size() == 2) || (verb == "dispose" && words.size() == 3)) {
    const auto writer = WriterOf(words[1]);
    if (!writer) {
      return writer.error();
    }
    if (verb == "dispose") {
      if (const Status disposed = (*writer)->Dispose(Number(words[2])); !disposed) {
        return disposed.error();
      }
    }
    return std::string();
  }
  return Error{ErrorCode::kInvalidArgument, "no such command: " + verb};
}

Result<std::string> PeerSession::Open(const Words& words) {
  const auto vendor = bus::ParseVendor(words[1]);
  if (!vendor) {
    return vendor.error();
  }
  config_.vendor = *vendor;
  config_.domain_id = Number(words[2]);
  config_.partition = words[3] == "-" ? "" : words[3];
  config_.ownership_strength = static_cast<std::int32_t>(Number(words[4]));
  config_.stream_lease = std::chrono::milliseconds(Number(words[5]));
  config_.stream_depth = static_cast<std::int32_t>(Number(words[6]));
  config_.send_loss_permille = static_cast<std::int32_t>(Number(words[7]));
  config_.participant_name = "limbcast-conformance-peer";
  auto opened = bus::Open(config_, [this](const bus::BusEvent& event) {
    const std::lock_guard lock(events_mutex_);
    events_ += std::string(bus::ToString(event.kind)) + "/" + std::string(event.topic) + "/" +
               event.detail + " ";
  });
  if (!opened) {
    return opened.error();
  }
  bus_ = std::move(opened).value();
  return bus_->Describe();
}

void PeerSession::Close() {
  while (!streams_.empty()) {
    (void)Stop(std::string(streams_.begin()->first));
  }
  writers_.clear();
  raw_writers_.clear();
  bus_.reset();
}

Result<TopicWriter*> PeerSession::WriterOf(const std::string& topic) {
  if (const auto it = writers_.find(topic); it != writers_.end()) {
    return it->second.get();
  }
  if (bus_ == nullptr) {
    return Error{ErrorCode::kUnavailable, "the bus is not open"};
  }
  auto made = MakeTopicWriter(*bus_, topic);
  if (!made) {
    return made.error();
  }
  return writers_.emplace(topic, std::move(made).value()).first->second.get();
}

Result<std::string> PeerSession::Write(const Words& words) {
  const auto writer = WriterOf(words[1]);
  if (!writer) {
    return writer.error();
  }
  const std::uint32_t first_sequence = Number(words[4]);
  const std::uint32_t rounds = Number(words[5]);
  const microseconds period(Number(words[6]));
  const auto begin = steady_clock::now();
  for (std::uint32_t round = 0; round < rounds; ++round) {
    std::this_thread::sleep_until(begin + period * round);  // the pace of a sensor, not a wait
    const Status written =
        WriteRound(**writer, Number(words[2]), Number(words[3]), first_sequence + round);
    if (!written) {
      return written.error();
    }
  }
  return std::to_string((steady_clock::now() - begin).count());
}

Result<std::string> PeerSession::Start(const Words& words) {
  const auto writer = WriterOf(words[1]);
  if (!writer) {
    return writer.error();
  }
  if (streams_.contains(words[1])) {
    return Error{ErrorCode::kUnavailable, "already streaming " + words[1]};
  }
  auto stream = std::make_unique<Stream>(Number(words[4]));
  stream->thread = std::thread([&stream = *stream, &writer = **writer, first = Number(words[2]),
                                keys = Number(words[3]), period = microseconds(Number(words[5]))] {
    for (auto next = steady_clock::now(); !stream.stop; next += period) {
      std::this_thread::sleep_until(next);
      (void)WriteRound(writer, first, keys, stream.next_sequence++);
    }
  });
  streams_.emplace(words[1], std::move(stream));
  return std::string();
}

Result<std::string> PeerSession::Stop(const std::string& topic) {
  const auto it = streams_.find(topic);
  if (it == streams_.end()) {
    return Error{ErrorCode::kNotFound, "not streaming " + topic};
  }
  it->second->stop = true;
  it->second->thread.join();
  const std::string next = std::to_string(it->second->next_sequence);
  streams_.erase(it);
  return next;
}

Result<std::string> PeerSession::SendGarbage(const std::string& topic,
                                             const std::vector<Bytes>& garbage) {
  auto it = raw_writers_.find(topic);
  if (it == raw_writers_.end()) {
    const auto names = NamesOf(topic);
    if (!names) {
      return names.error();
    }
    auto made = config_.vendor == bus::Vendor::kFast ? MakeRawFastWriter(config_, *names)
                                                     : MakeRawCycloneWriter(config_, *names);
    if (!made) {
      return made.error();
    }
    it = raw_writers_.emplace(topic, std::move(made).value()).first;
  }
  for (const Bytes& payload : garbage) {
    if (const Status sent = it->second->Write(payload); !sent) {
      return sent.error();
    }
  }
  return std::to_string(garbage.size());
}

Result<std::string> PeerSession::Counters(const std::string& topic) {
  const auto writer = WriterOf(topic);
  if (!writer) {
    return writer.error();
  }
  const bus::EndpointCounters counters = (*writer)->counters();
  return "matched=" + std::to_string(counters.matched) +
         " incompatible_qos=" + std::to_string(counters.incompatible_qos);
}

Result<std::string> PeerSession::Events() {
  const std::lock_guard lock(events_mutex_);
  return events_;
}

}  // namespace limbcast::conformance
