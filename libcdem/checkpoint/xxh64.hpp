// XXH64, the checksum of checkpoints (Collet, xxHash specification 0.1.1), by libxxhash: 64 bits, several bytes a cycle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

struct XXH64_state_s; // of libxxhash

namespace cdem {

class Xxh64 {
public:
  Xxh64();
  void add(const void* data, std::size_t bytes);
  std::uint64_t value() const; // of all bytes so far, with seed 0

private:
  struct Free {
    void operator()(XXH64_state_s*) const;
  };
  std::unique_ptr<XXH64_state_s, Free> state_;
};

std::uint64_t xxh64(const void* data, std::size_t bytes);

} // namespace cdem
