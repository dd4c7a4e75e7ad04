// Limit of the memory of this program. Beyond it the program ends with one line, before the kernel kills it.
#pragma once

#include <cstddef>
#include <string>

namespace cdem::app {

inline constexpr std::size_t least_memory = std::size_t{64} << 20; // bytes that can be asked for

std::size_t
machine_memory(); // bytes: of the machine or, if that is less, of the container this process is in

// "12G", "800M", "1.5T", or plain bytes. Throws UsageError.
std::size_t memory_value(const std::string& option, const std::string& text);

// From now on this process and those it starts may take so many bytes beyond what it holds; 0: nine tenths of the
// machine's. Of `sharing` such processes on this machine each may take its part. A limit that the shell has set and that is
// lower stays. Gives back what may be taken.
std::size_t limit_memory(std::size_t bytes, int sharing = 1);

} // namespace cdem::app
