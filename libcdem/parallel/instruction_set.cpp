#include "libcdem/parallel/instruction_set.hpp"

#include "libgeom/core/error.hpp"

#include <algorithm>
#include <cstdlib>

namespace cdem {
namespace {

constexpr const char* variable = "CDEM_INSTRUCTION_SET";

bool has(InstructionSet set) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  return set == InstructionSet::baseline || (set == InstructionSet::avx2 ? avx2 : avx512);
#else
  return set == InstructionSet::baseline;
#endif
}

InstructionSet chosen() {
  const std::vector<InstructionSet> sets = instruction_sets();
  const char* const wanted = std::getenv(variable);
  if (!wanted || *wanted == '\0')
    return sets.back();
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (name(set) != wanted)
      continue;
    if (!has(set))
      throw geom::InputError(variable, wanted, "a set that this processor has",
                             "the widest it has is " + name(sets.back()) +
                                 "; leave the variable out to use that");
    return set;
  }
  throw geom::InputError(variable, wanted, "baseline, avx2 or avx512",
                         "leave it out to use the widest that the processor has (" + name(sets.back()) + ")");
}

} // namespace

InstructionSet instruction_set() {
  static const InstructionSet set = chosen();
  return set;
}

std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512})
    if (has(set))
      sets.push_back(set);
  return sets;
}

std::string name(InstructionSet set) {
  return set == InstructionSet::avx512 ? "avx512" : set == InstructionSet::avx2 ? "avx2" : "baseline";
}

} // namespace cdem
