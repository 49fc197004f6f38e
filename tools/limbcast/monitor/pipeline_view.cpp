#include "tools/limbcast/monitor/pipeline_view.hpp"

namespace limbcast::tool {

template <typename T, typename Use>
Status PipelineView::Listen(bus::Bus& bus, std::unique_ptr<bus::Reader<T>>& reader, Use use) {
  auto made = bus.MakeReader<T>({.on_sample =
                                     [this, use](const T& value, const bus::SampleInfo& info) {
                                       const std::lock_guard lock(mutex_);
                                       use(model_, value, info.received_at);
                                     },
                                 .on_disposed = {}});
  if (!made) {
    return made.error();
  }
  reader = std::move(*made);
  return Ok();
}

Result<std::unique_ptr<PipelineView>> PipelineView::Make(bus::Bus& bus, Options options) {
  std::unique_ptr<PipelineView> view(new PipelineView);
  const auto timeless = [](PipelineModel& model, const auto& value, Time) { model.On(value); };
  const auto timed = [](PipelineModel& model, const auto& value, Time at) { model.On(value, at); };
  Status made = view->Listen(bus, view->health_, timeless);
  if (made) {
    made = view->Listen(bus, view->roster_, timeless);
  }
  if (made) {
    made = view->Listen(bus, view->skeletons_, timed);
  }
  if (made && options.segment_states) {
    auto states = bus::SegmentStateReader::Make(
        bus, [self = view.get()](std::span<const body::SegmentState> of_body,
                                 const bus::SampleInfo& info) {
          const std::lock_guard lock(self->mutex_);
          for (const body::SegmentState& state : of_body) {
            self->model_.On(state, info.received_at);
          }
        });
    if (!states) {
      return states.error();
    }
    view->states_ = std::move(*states);
  }
  if (made && options.truth) {
    made = view->Listen(bus, view->truths_, timeless);
  }
  if (!made) {
    return made.error();
  }
  return view;
}

}  // namespace limbcast::tool
