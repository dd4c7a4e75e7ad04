// Files that are either complete or absent. A file is written under another name, flushed to the disk, and then
// renamed. A checksum of the whole file is verified before any of it is used.
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
