#include "libcdem/checkpoint/xxh64.hpp"

#include <new>
#include <xxhash.h>

namespace cdem {

void Xxh64::Free::operator()(XXH64_state_s* state) const {
  XXH64_freeState(state);
}

Xxh64::Xxh64() : state_(XXH64_createState()) {
  if (!state_)
    throw std::bad_alloc();
  XXH64_reset(state_.get(), 0);
}

void Xxh64::add(const void* data, std::size_t bytes) {
  XXH64_update(state_.get(), data, bytes);
}

std::uint64_t Xxh64::value() const {
  return XXH64_digest(state_.get());
}

std::uint64_t xxh64(const void* data, std::size_t bytes) {
  return XXH64(data, bytes, 0);
}

} // namespace cdem
