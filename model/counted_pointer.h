// SPDX-License-Identifier: GPL-3.0-or-later
// A pointer of one word to something that counts its owners itself: half of std::shared_ptr, which
// matters where an earlier state is kept for every step.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace tranos::model {

// How many pointers own the value that holds it; a copy of that value starts with none.
struct OwnerCount {
  std::atomic<std::uint32_t> count{0};
  OwnerCount() = default;
  OwnerCount(const OwnerCount&) {}
  OwnerCount& operator=(const OwnerCount&) { return *this; }
};

// T has a field `OwnerCount owners`; Destroy(T*) is found by argument, and deletes.
template <class T>
class CountedPointer {
 public:
  CountedPointer() = default;
  // Takes part in owning `value`, which was made with new.
  explicit CountedPointer(T* value) : value_(value) { Retain(); }
  CountedPointer(const CountedPointer& other) : value_(other.value_) { Retain(); }
  CountedPointer(CountedPointer&& other) noexcept : value_(std::exchange(other.value_, nullptr)) {}
  CountedPointer& operator=(CountedPointer other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~CountedPointer() {
    if (value_ && value_->owners.count.fetch_sub(1, std::memory_order_acq_rel) == 1) {
      Destroy(value_);
    }
  }

  T* get() const { return value_; }
  T& operator*() const { return *value_; }
  T* operator->() const { return value_; }
  explicit operator bool() const { return value_ != nullptr; }
  // Nobody else sees the value, so that it may be changed in place.
  bool unique() const { return value_->owners.count.load(std::memory_order_acquire) == 1; }

 private:
  void Retain() {
    if (value_) value_->owners.count.fetch_add(1, std::memory_order_relaxed);
  }
  T* value_ = nullptr;
};

}  // namespace tranos::model
