#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/base/expects.hpp"
#include "common/filters/batch_kernels.hpp"
#include "common/filters/filter.hpp"
#include "common/filters/lane_block.hpp"

namespace limbcast::filters {

/// Places for filters that are computed together.
class AnySensorBatch {
 public:
  static constexpr int kSeats = 8;
  virtual ~AnySensorBatch() = default;
  /// Steps what was submitted since the last time.
  virtual void Run() = 0;
  [[nodiscard]] virtual int seats_taken() const = 0;
};

/// Eight filters of one kind and configuration whose cores are kept number by number and stepped
/// together (DESIGN-batch.md). Start, gaps and other special samples are the affair of each filter,
/// on a copy of its core. What a seat gives does not depend on who else sits there.
///
/// Filter: GaussNewtonOrientation or BoundedMotionFilter. Thread-compatible; allocates nothing
/// after construction.
template <typename Filter>
class SensorBatch final : public AnySensorBatch {
 public:
  using Config = typename Filter::Config;
  using Number = typename Filter::Number;
  using CoreInput = typename Filter::CoreInput;
  using CoreState = typename Filter::CoreState;
  using Kernel = void (*)(const Config&, const std::byte* inputs, std::byte* states);

  /// @param width  lanes of the kernel.
  SensorBatch(const Config& config, Kernel kernel, int width)
      : config_(config),
        kernel_(kernel),
        width_(width),
        present_offset_(PresentOffset(width)),
        inputs_(MakeBlocks<CoreInput>()),
        states_(MakeBlocks<CoreState>()) {
    Expects(lanes::IsBlockWidth(width), "a width that there is");
  }

  /// A filter that steps here, or null when all seats are taken. Its owner keeps the batch.
  [[nodiscard]] static std::unique_ptr<BatchedFilter> Seat(std::shared_ptr<SensorBatch> batch,
                                                           std::unique_ptr<Filter> filter) {
    for (int seat = 0; seat < kSeats; ++seat) {
      if (!batch->taken_[Index(seat)]) {
        return std::make_unique<Seated>(std::move(batch), seat, std::move(filter));
      }
    }
    return nullptr;
  }

  void Run() override {
    if (submitted_.none()) {
      return;
    }
    constexpr unsigned long kAll = (1UL << kSeats) - 1UL;
    const unsigned long group = kAll >> static_cast<unsigned>(kSeats - width_);
    for (int first = 0; first < kSeats; first += width_) {
      if (((submitted_.to_ulong() >> static_cast<unsigned>(first)) & group) != 0) {
        std::byte* const inputs = At(inputs_, first);
        kernel_(config_, inputs, At(states_, first));
        // `present` of all lanes: none has a reading until the next Submit.
        std::fill_n(inputs + present_offset_, static_cast<std::size_t>(width_) * sizeof(Number),
                    std::byte{0});
      }
    }
    submitted_.reset();
  }

  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] int seats_taken() const override { return static_cast<int>(taken_.count()); }

 private:
  struct alignas(kBlockAlignment_bytes) Cell {
    std::array<std::byte, kBlockAlignment_bytes> bytes;
  };
  using Blocks = std::vector<Cell>;
  // Large cores live in their lanes alone: the filters share one place for what they look at.
  static constexpr bool kLends = requires(Filter & filter, CoreState& place) {
    filter.LendCoreState(place);
  };
  struct Nothing {};

  class Seated final : public BatchedFilter {
   public:
    Seated(std::shared_ptr<SensorBatch> batch, int seat, std::unique_ptr<Filter> filter)
        : batch_(std::move(batch)),
          seat_(seat),
          width_(batch_->width_),
          lane_(seat % width_),
          inputs_(batch_->At(batch_->inputs_, seat)),
          states_(batch_->At(batch_->states_, seat)),
          filter_(std::move(filter)) {
      batch_->taken_.set(Index(seat_));
      PutAll();
      if constexpr (kLends) {
        filter_->LendCoreState(batch_->scratch_);
      }
    }
    Seated(const Seated&) = delete;
    Seated& operator=(const Seated&) = delete;
    ~Seated() override { batch_->taken_.reset(Index(seat_)); }

    void Submit(const sensing::MargSample& sample) override {
      FetchPassed();
      step_ = filter_->Pass(sample);
      if (step_ == SampleStep::kPlain) {
        lanes::PutLane<CoreInput, Number>(inputs_, width_, lane_, filter_->core_input());
        batch_->submitted_.set(Index(seat_));
      }
    }

    SampleVerdict Take() override {
      SampleVerdict verdict = SampleVerdict::kNoData;
      switch (step_) {
        case SampleStep::kPlain:
          Filter::ForEachReported(filter_->core_state(),
                                  [this](auto& member) { this->Fetch(member); });
          return filter_->Report();
        case SampleStep::kSpecial:
          FetchAll();
          verdict = filter_->StepAlone();
          PutAll();
          return verdict;
        case SampleStep::kNone:
          break;
      }
      return filter_->refusal();
    }

    [[nodiscard]] SampleVerdict Update(const sensing::MargSample& sample) override {
      Submit(sample);
      batch_->Run();
      return Take();
    }
    [[nodiscard]] const FilterEstimate& estimate() const override { return filter_->estimate(); }
    void Reset() override {
      filter_->Reset();
      PutAll();
    }
    [[nodiscard]] std::string_view name() const override { return filter_->name(); }
    [[nodiscard]] std::size_t state_size_bytes() const override {
      return filter_->state_size_bytes();
    }
    void SaveState(std::span<std::byte> out) const override {
      FetchAll();
      filter_->SaveState(out);
    }
    [[nodiscard]] Status RestoreState(std::span<const std::byte> in) override {
      FetchAll();
      Status restored = filter_->RestoreState(in);
      PutAll();
      return restored;
    }

   private:
    // The core in the filter gets the batch's value of one of its members.
    template <typename Member>
    void Fetch(Member& member) const {
      const auto* const core = reinterpret_cast<const std::byte*>(&filter_->core_state());
      const auto offset =
          static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&member) - core);
      lanes::GetLane<Member, Number>(states_ + offset * static_cast<std::size_t>(width_), width_,
                                     lane_, member);
    }
    void FetchAll() const { Fetch(filter_->core_state()); }
    void PutAll() {
      lanes::PutLane<CoreState, Number>(states_, width_, lane_, filter_->core_state());
    }
    // What Pass looks at: the place of the core may hold another seat's.
    void FetchPassed() const {
      if constexpr (kLends) {
        Filter::ForEachPassed(filter_->core_state(), [this](auto& member) { this->Fetch(member); });
      }
    }

    std::shared_ptr<SensorBatch> batch_;
    int seat_;
    int width_;
    int lane_;
    std::byte* inputs_;  // of its group
    std::byte* states_;
    std::unique_ptr<Filter> filter_;
    SampleStep step_ = SampleStep::kNone;
  };

  template <typename Record>
  [[nodiscard]] Blocks MakeBlocks() const {
    const auto groups = static_cast<std::size_t>(kSeats / width_);
    const std::size_t cells =
        (sizeof(Record) * static_cast<std::size_t>(width_) + sizeof(Cell) - 1) / sizeof(Cell);
    return Blocks(groups * cells, Cell{});
  }
  // The block of the group that `seat` belongs to.
  [[nodiscard]] std::byte* At(Blocks& blocks, int seat) const {
    const std::size_t cells = blocks.size() / static_cast<std::size_t>(kSeats / width_);
    return blocks[cells * static_cast<std::size_t>(seat / width_)].bytes.data();
  }
  // Where the flags `present` of a block of inputs begin.
  [[nodiscard]] static std::size_t PresentOffset(int width) {
    const CoreInput layout{};
    const auto* const record = reinterpret_cast<const std::byte*>(&layout);
    const auto* const member = reinterpret_cast<const std::byte*>(&layout.present);
    return static_cast<std::size_t>(member - record) * static_cast<std::size_t>(width);
  }
  [[nodiscard]] static std::size_t Index(int seat) { return static_cast<std::size_t>(seat); }

  Config config_;
  Kernel kernel_;
  int width_;
  std::size_t present_offset_;
  Blocks inputs_;
  Blocks states_;
  std::conditional_t<kLends, CoreState, Nothing> scratch_;
  std::bitset<kSeats> taken_;
  std::bitset<kSeats> submitted_;
};

}  // namespace limbcast::filters
