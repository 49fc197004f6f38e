#include "services/fusion/filter_keeper.hpp"

#include <algorithm>
#include <utility>

namespace limbcast::fusion {

FilterKeeper::FilterKeeper(const FilterStore& store, const Clock& clock, std::size_t workers,
                           Ask ask, Tell tell)
    : store_(store), clock_(clock), ask_(std::move(ask)), tell_(std::move(tell)) {
  asked_.resize(workers);
  Renew();
}

void FilterKeeper::Renew() {
  for (auto& snapshot : asked_) {
    snapshot = std::make_shared<FilterSnapshot>();
  }
}

void FilterKeeper::Start(Duration period) {
  thread_.emplace("fusion-keeper", period, [this] { Tick(); });
}

void FilterKeeper::Tick() {
  const bool answered = std::all_of(asked_.begin(), asked_.end(), [](const auto& snapshot) {
    return snapshot->complete.load(std::memory_order_acquire);
  });
  if (waiting_ && !answered) {
    return;  // a worker is busy, and its snapshot belongs to it
  }
  if (waiting_) {
    Save();
  }
  waiting_ = true;
  for (std::size_t worker = 0; waiting_ && worker < asked_.size(); ++worker) {
    asked_[worker]->Clear();
    waiting_ = ask_(worker, asked_[worker]);
  }
  if (!waiting_) {  // those that were asked may answer yet, into what nobody looks at
    Renew();
  }
}

void FilterKeeper::SaveNow(std::vector<std::shared_ptr<FilterSnapshot>> snapshots) {
  asked_ = std::move(snapshots);
  waiting_ = false;
  Save();
}

void FilterKeeper::Save() {
  const Status written = store_.Save(asked_, clock_.Now());
  ++(written ? saved_ : errors_);
  tell_(written);
}

}  // namespace limbcast::fusion
