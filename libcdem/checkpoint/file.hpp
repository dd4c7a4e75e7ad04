// Files that are whole or not there: written beside, brought to the disk, then renamed; a checksum over everything
// is verified before anything is used.
//
//     "cdem " and what it is, 16 bytes | format, u32 | length of the content, u64 | content | XXH64 of all before
#pragma once

#include <filesystem>
#include <string>

namespace cdem {

enum class SavedKind { checkpoint, state }; // of a whole run; of one model

// Throws FileError.
void write_saved(const std::filesystem::path&, SavedKind, const std::string& content);
// The content. Throws FileError: not such a file, of another format, damaged.
std::string read_saved(const std::filesystem::path&, SavedKind);

} // namespace cdem
