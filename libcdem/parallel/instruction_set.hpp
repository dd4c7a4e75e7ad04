// The instruction set that kernels are compiled for and take when they run: the widest that the processor has, or the one
// that the environment variable CDEM_INSTRUCTION_SET names. All give the same bits.
//
// A kernel is written once, as a CDEM_INLINE function of which everything it calls is inlined too. `best` compiles it
// for each set and calls the one in use:
//
//   CDEM_INLINE void add_kernel(const double* from, std::int64_t count, double* to) { ... }
//   void add(const double* from, std::int64_t count, double* to) { simd::best<add_kernel>(from, count, to); }
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cdem {

enum class InstructionSet { baseline, avx2, avx512 }; // x86-64, x86-64-v3, x86-64-v4

// Decided at the first call. Throws geom::InputError for a name that is none, or a set that the processor lacks.
InstructionSet instruction_set();

// Those that this processor has, from the narrowest to the widest.
std::vector<InstructionSet> instruction_sets();
std::string name(InstructionSet); // as in CDEM_INSTRUCTION_SET

namespace simd {

#if defined(__x86_64__)
// noipa: GCC 12 left out calls of kernels that it took for functions without an effect.
template <auto& kernel, class... Arguments>
__attribute__((noipa, target("arch=x86-64-v4"))) auto with_avx512(Arguments... arguments) {
  return kernel(arguments...);
}
template <auto& kernel, class... Arguments>
__attribute__((noipa, target("arch=x86-64-v3"))) auto with_avx2(Arguments... arguments) {
  return kernel(arguments...);
}
#endif

// For a kernel that is written for any width: wide takes eight numbers at a time, narrow four.
template <auto& wide, auto& narrow, class... Arguments>
auto best_width(Arguments&&... arguments) {
#if defined(__x86_64__)
  switch (instruction_set()) {
  case InstructionSet::avx512:
    return with_avx512<wide, Arguments...>(std::forward<Arguments>(arguments)...);
  case InstructionSet::avx2:
    return with_avx2<narrow, Arguments...>(std::forward<Arguments>(arguments)...);
  case InstructionSet::baseline:
    break;
  }
#endif
  return narrow(std::forward<Arguments>(arguments)...);
}

template <auto& kernel, class... Arguments>
auto best(Arguments&&... arguments) {
  return best_width<kernel, kernel>(std::forward<Arguments>(arguments)...);
}

} // namespace simd
} // namespace cdem
