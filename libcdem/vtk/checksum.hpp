// A checksum as the last line of our XML files, an XML comment that other readers pass over. VTK's readers
// crash on some damaged files (a zero block size is enough), so ours is compared before VTK sees the file.
#pragma once

#include <string>

namespace cdem {

bool add_checksum(const std::string& path); // false when it cannot be written

enum class Checksum { none, wrong, right };
Checksum check_checksum(const std::string& path); // none: no such line, the file is not one of ours

} // namespace cdem
