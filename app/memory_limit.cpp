// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/memory_limit.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

// The mutable variables of the program outside any function's frame: operator new has no other
// place for what it counts. With sanitizers it counts the same, and their own checks of what malloc
// gives go on. NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
constinit std::atomic<std::int64_t> bytes_left{INT64_MAX};

// What the first refusal frees, so that it can be told of.
constinit std::atomic<std::int64_t> reserve{0};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void* Allocate(std::size_t size, std::size_t alignment) {
  // Counted before it is taken, so that one huge request cannot bring the machine down.
  if (static_cast<std::int64_t>(size) < 0 ||
      bytes_left.load(std::memory_order_relaxed) < static_cast<std::int64_t>(size)) {
    bytes_left.fetch_add(reserve.exchange(0), std::memory_order_relaxed);
    throw std::bad_alloc();
  }
  void* const memory =
      alignment ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                : std::malloc(size ? size : 1);
  if (!memory) throw std::bad_alloc();
  bytes_left.fetch_sub(static_cast<std::int64_t>(malloc_usable_size(memory)),
                       std::memory_order_relaxed);
  return memory;
}

// For those who ask without exceptions, as std::stable_sort does.
void* AllocateOrNull(std::size_t size, std::size_t alignment) noexcept {
  try {
    return Allocate(size, alignment);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void Release(void* memory) noexcept {
  if (!memory) return;
  bytes_left.fetch_add(static_cast<std::int64_t>(malloc_usable_size(memory)),
                       std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return Allocate(size, 0); }
void* operator new[](std::size_t size) { return Allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return Allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return Allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return AllocateOrNull(size, 0);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return AllocateOrNull(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return AllocateOrNull(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return AllocateOrNull(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { Release(memory); }
void operator delete[](void* memory) noexcept { Release(memory); }
void operator delete(void* memory, std::size_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { Release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { Release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { Release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { Release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { Release(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
  Release(memory);
}
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept {
  Release(memory);
}

namespace tranos::app {

void LimitMemory(std::uint64_t bytes) {
  constexpr std::int64_t kReserve = 16'000'000;
  bytes_left = bytes > INT64_MAX ? INT64_MAX : static_cast<std::int64_t>(bytes);
  reserve = kReserve;
}

}  // namespace tranos::app
