#pragma once

#include <memory>

namespace limbcast::filters {

/// A value with a place of its own, until somebody lends it one that it shares with others: who
/// lends then says whose value is there. Copies have places of their own.
template <typename T>
class Lendable {
 public:
  Lendable() : own_(std::make_unique<T>()), place_(own_.get()) {}
  Lendable(const Lendable& other) : own_(std::make_unique<T>(*other.place_)), place_(own_.get()) {}
  Lendable& operator=(const Lendable& other) {
    if (this != &other) {
      *place_ = *other.place_;
    }
    return *this;
  }
  ~Lendable() = default;

  /// From now on the value is in `place`, which outlives this; not copied there.
  void Lend(T& place) {
    place_ = &place;
    own_.reset();
  }

  [[nodiscard]] T& operator*() { return *place_; }
  [[nodiscard]] const T& operator*() const { return *place_; }
  [[nodiscard]] T* operator->() { return place_; }
  [[nodiscard]] const T* operator->() const { return place_; }

 private:
  std::unique_ptr<T> own_;
  T* place_;
};

}  // namespace limbcast::filters
