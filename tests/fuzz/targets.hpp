// What is fuzzed: every reader of files and the argument tables of scripts. A target takes any bytes; whatever they are it
// comes back, and what it refuses it refuses with an exception of ours. Anything else is a finding.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace fuzz {

using Target = std::function<void(const std::string& bytes)>;

const std::map<std::string, Target>& targets();

// One input. What the target refuses with an exception of ours is well; a message of several lines is not.
void run(const Target&, const std::string& bytes);

// The bytes as a file of this process's own folder; the same file each time.
std::string as_file(const std::string& name, const std::string& bytes);

// Numbers drawn from the bytes in order; 0 when they are used up.
class Draw {
public:
  explicit Draw(const std::string& bytes) : bytes_(bytes) {}
  bool any() const { return next_ < bytes_.size(); }
  std::uint32_t byte() { return any() ? static_cast<unsigned char>(bytes_[next_++]) : 0; }
  std::uint32_t word() { // 4 bytes, little-endian
    std::uint32_t word = 0;
    for (int shift = 0; shift < 32; shift += 8)
      word |= byte() << shift;
    return word;
  }

private:
  const std::string& bytes_;
  std::size_t next_ = 0;
};

void read_stl(const std::string&);
void read_water(const std::string&);
void read_dxf(const std::string&);
void read_polygons(const std::string&); // the first byte chooses the format; in a child
void read_vtk(const std::string&);      // in a child
void record(const std::string&);        // cdem.record, the first byte chooses .csv or .AT2
void read_mesh(const std::string&);     // the first byte chooses the format
void read_step(const std::string&);     // in a child
void child_answer(const std::string&);  // what a child process hands back
void saved_file(const std::string&);    // head and checksum
void state(const std::string&);         // changes of a whole state
void cut_model(const std::string&);     // changes of a whole checkpoint with its model
void journal(const std::string&);       // of a checkpoint
void pile(const std::string&);          // pile.json
void csv(const std::string&);           // cdem.read_csv
void arguments(const std::string&);     // tables of calls of the module

} // namespace fuzz
