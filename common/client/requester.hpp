#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"

namespace limbcast::client {

/// A client's number, drawn for each process: not 0.
[[nodiscard]] inline std::uint64_t DrawClientUid() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device() | 1U;
}

/// Sends requests and finds the answer to each among all that travel. Thread-safe.
template <typename Request, typename Reply>
class Requester {
 public:
  using Clock = std::chrono::steady_clock;

  /// `bus` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<Requester>> Make(bus::Bus& bus,
                                                               std::uint64_t client_uid) {
    std::unique_ptr<Requester> requester(new Requester(client_uid));
    auto writer = bus.MakeWriter<Request>();
    if (!writer) {
      return writer.error();
    }
    requester->writer_ = std::move(*writer);
    auto reader = bus.MakeReader<Reply>(
        {.on_sample = [self = requester.get()](const Reply& reply,
                                               const bus::SampleInfo&) { self->Take(reply); },
         .on_disposed = {}});
    if (!reader) {
      return reader.error();
    }
    requester->reader_ = std::move(*reader);
    return requester;
  }

  /// Somebody listens, and somebody answers.
  [[nodiscard]] bool heard() const {
    return writer_->counters().matched > 0 && reader_->counters().matched > 0;
  }

  /// Waits until `until` for somebody who listens (discovery takes a moment, and a request that
  /// nobody hears is gone), sends, and waits for the answer. Fills in client_uid and request_id.
  /// The request is sent again and again under its number until it is answered, and every service
  /// does it once (roster::AnsweredCommands): that we have found the others does not mean that they
  /// have found us yet, and what comes before is lost on either way. Fails with kUnavailable
  /// (nobody listens) or kTimeout (no answer).
  [[nodiscard]] Result<Reply> Ask(Request request, Clock::time_point until) {
    constexpr auto kRepeat = std::chrono::milliseconds(200);
    constexpr auto kLookAgain = std::chrono::milliseconds(20);  // matching wakes nobody
    std::unique_lock lock(mutex_);
    while (!heard()) {
      if (Clock::now() >= until) {
        return Error{ErrorCode::kUnavailable, "nobody listens"};
      }
      answered_.wait_until(lock, std::min(until, Clock::now() + kLookAgain));
    }
    request.client_uid = client_uid_;
    request.request_id = ++requests_;
    const auto waiting = waiting_.try_emplace(request.request_id).first;
    bool answered = false;
    do {
      lock.unlock();
      const Status written = writer_->Write(request);
      writer_->Flush();
      lock.lock();
      if (!written) {
        waiting_.erase(waiting);
        return written.error();
      }
      answered = answered_.wait_until(lock, std::min(until, Clock::now() + kRepeat),
                                      [&] { return waiting->second.has_value(); });
    } while (!answered && Clock::now() < until);
    const auto node = waiting_.extract(waiting);
    if (!answered) {
      return Error{ErrorCode::kTimeout, "no answer"};
    }
    return std::move(*node.mapped());
  }

 private:
  explicit Requester(std::uint64_t client_uid) : client_uid_(client_uid) {}

  void Take(const Reply& reply) {
    if (reply.client_uid != client_uid_) {
      return;  // somebody else's
    }
    const std::scoped_lock lock(mutex_);
    const auto waiting = waiting_.find(reply.request_id);
    if (waiting != waiting_.end() && !waiting->second) {
      waiting->second = reply;
      answered_.notify_all();
    }
  }

  const std::uint64_t client_uid_;
  mutable std::mutex mutex_;  // guards the next three
  std::condition_variable answered_;
  std::uint64_t requests_ = 0;
  std::map<std::uint64_t, std::optional<Reply>> waiting_;  // by request_id
  std::unique_ptr<bus::Writer<Request>> writer_;
  std::unique_ptr<bus::Reader<Reply>> reader_;
};

}  // namespace limbcast::client
