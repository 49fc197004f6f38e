#include "services/fusion/state_publisher.hpp"

#include <utility>

namespace limbcast::fusion {

Result<StateWriters> StateWriters::Make(bus::Bus& bus, bool frames) {
  StateWriters made;
  if (frames) {
    auto writer = bus.MakeWriter<body::SegmentFrame>();
    if (!writer) {
      return writer.error();
    }
    made.frames = std::move(*writer);
  } else {
    auto writer = bus.MakeWriter<body::SegmentState>();
    if (!writer) {
      return writer.error();
    }
    made.single = std::move(*writer);
  }
  return made;
}

std::int32_t StateWriters::readers() const {
  if (single != nullptr) {
    return single->counters().matched;
  }
  return frames != nullptr ? frames->counters().matched : 0;
}

StatePublisher::StatePublisher(StateWriters& writers, CounterCells& counters)
    : writers_(writers), counters_(counters) {
  if (writers_.frames != nullptr) {
    frame_.states.reserve(body::kMaxStatesPerFrame);
  }
}

void StatePublisher::Write(const body::SegmentState& state) {
  if (writers_.single != nullptr) {
    counters_.AddPublished(writers_.single->Write(state).ok());
    return;
  }
  if (frame_.body_id != state.body_id || frame_.states.size() == body::kMaxStatesPerFrame) {
    Send();
    frame_.body_id = state.body_id;
  }
  frame_.states.push_back(state);
}

void StatePublisher::Send() {
  if (frame_.states.empty()) {
    return;
  }
  const bool ok = writers_.frames->Write(frame_).ok();
  for (std::size_t i = 0; i < frame_.states.size(); ++i) {
    counters_.AddPublished(ok);
  }
  frame_.states.clear();
}

void StatePublisher::Dispose(const body::SegmentState& key) {
  if (writers_.single != nullptr) {
    counters_.AddPublished(writers_.single->Dispose(key).ok());
  }
}

void StatePublisher::DisposeBody(BodyId body_id) {
  if (writers_.frames == nullptr) {
    return;
  }
  Send();
  body::SegmentFrame key;
  key.body_id = body_id;
  counters_.AddPublished(writers_.frames->Dispose(key).ok());
}

void StatePublisher::Flush() {
  if (writers_.single != nullptr) {
    writers_.single->Flush();
    return;
  }
  Send();
  writers_.frames->Flush();
}

}  // namespace limbcast::fusion
