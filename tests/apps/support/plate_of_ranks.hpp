// A plate that several processes solve together, and how a test finds them.
#pragma once

#include "tests/apps/support/case_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <string>

#include <unistd.h>

namespace testing {

inline const std::string plate = shaken_plate("{1.2, 0.5, 0.05}", "{24, 10, 1}", 400);

struct PlateFolder : CaseFolder {
  explicit PlateFolder(const std::string& text = plate) : CaseFolder({{"plate/case.lua", text}}) {}
  std::string report() const { return read_file(folder / "out/report.json"); }
  std::string log() const { return read_file(folder / "out/cdem.log"); }
};

inline const std::string& report_of_one() {
  static const std::string report = [] {
    PlateFolder place;
    REQUIRE(place.cdem({"run", "plate/case.lua", "--output", "out", "--threads", "1"}).exit_code == 0);
    return place.report();
  }();
  return report;
}

// Processes of ours in the folder with this rank; 0: none.
inline pid_t process_of_rank(const std::filesystem::path& folder, int rank) {
  const std::string wanted = "OMPI_COMM_WORLD_RANK=" + std::to_string(rank) + '\0';
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", none)) {
    const std::string name = entry.path().filename().string();
    if (!std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; }) ||
        std::filesystem::read_symlink(entry.path() / "cwd", none) != folder)
      continue;
    if (read_file(entry.path() / "environ").find(wanted) != std::string::npos)
      return std::stoi(name);
  }
  return 0;
}

} // namespace testing
