// Files and snapshots compared to the bit.
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

namespace testing {

using namespace cdem;

inline std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

inline void overwrite(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

inline void require_same(const std::vector<SnapshotField>& a, const std::vector<SnapshotField>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    INFO(a[i].name);
    CHECK(a[i].name == b[i].name);
    CHECK(a[i].unit == b[i].unit);
    CHECK(a[i].components == b[i].components);
    CHECK(a[i].integer == b[i].integer);
    CHECK(same_bits(a[i].values, b[i].values));
  }
}

// Places instead of node numbers, so that two ways to number them compare equal.
inline std::multiset<std::vector<double>> places(const Snapshot& s,
                                                 const std::vector<geom::Triangle>& triangles) {
  std::multiset<std::vector<double>> set;
  for (const geom::Triangle& t : triangles) {
    std::vector<double> key;
    // Start at the smallest node, keep the sense: two triangles are equal only when they face the same way.
    const std::size_t first = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
    for (std::size_t c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k)
        key.push_back(s.points[static_cast<std::size_t>(t[(first + c) % 3])][k]);
    set.insert(key);
  }
  return set;
}

inline std::set<std::array<int, 2>> sorted(std::vector<std::array<int, 2>> edges) {
  for (auto& e : edges)
    std::sort(e.begin(), e.end());
  return {edges.begin(), edges.end()};
}

// VTK's reader of .vtkhdf lists fields by name.
inline std::vector<SnapshotField> by_name(std::vector<SnapshotField> fields) {
  std::sort(fields.begin(), fields.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return fields;
}

inline void require_same(const Snapshot& r, const Snapshot& s) {
  CHECK(r.title == s.title);
  CHECK(r.body_names == s.body_names);
  CHECK(r.time == s.time);
  CHECK(r.step == s.step);
  CHECK(r.points == s.points);
  CHECK(r.tets == s.tets);
  require_same(by_name(r.point_fields), by_name(s.point_fields));
  require_same(by_name(r.cell_fields), by_name(s.cell_fields));
  CHECK(r.bonds.points == s.bonds.points);
  CHECK(r.bonds.triangles == s.bonds.triangles);
  require_same(by_name(r.bonds.point_fields), by_name(s.bonds.point_fields));
  require_same(by_name(r.bonds.triangle_fields), by_name(s.bonds.triangle_fields));
}

} // namespace testing
