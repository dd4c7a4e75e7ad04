// Small ASCII DXF files: a roof of two squares that meet in a ridge along y, as each kind of face.
#pragma once

#include <array>
#include <string>

inline std::string dxf(const std::string& entities, const std::string& header = "") {
  return "0\nSECTION\n2\nHEADER\n" + header + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities +
         "0\nENDSEC\n0\nEOF\n";
}

// Ends of the eaves and the ridge: x of 0, 1, 2 with z of 0, 1, 0; y of 0 and 1.
inline std::string dxf_point(int i, int j, int corner = 0) {
  static const std::array<const char*, 3> x{"0", "1", "2"}, z{"0", "1", "0"};
  const std::string c = std::to_string(corner);
  return "1" + c + "\n" + x[i] + "\n2" + c + "\n" + std::to_string(j) + "\n3" + c + "\n" + z[i] + "\n";
}

inline std::string dxf_faces() {
  std::string out;
  for (int i = 0; i < 2; ++i)
    out += "0\n3DFACE\n8\nroof\n" + dxf_point(i, 0, 0) + dxf_point(i + 1, 0, 1) + dxf_point(i + 1, 1, 2) +
           dxf_point(i, 1, 3);
  return dxf(out);
}

inline std::string dxf_polyface() {
  std::string out = "0\nPOLYLINE\n66\n1\n70\n64\n71\n6\n72\n2\n";
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      out += "0\nVERTEX\n" + dxf_point(i, j) + "70\n192\n";
  for (int i = 0; i < 2; ++i) {
    const int a = 2 * i + 1; // numbers from 1; an edge of the second is not drawn
    const std::array<int, 4> face{a, a + 2, a + 3, a + 1};
    out += "0\nVERTEX\n10\n0\n20\n0\n30\n0\n70\n128\n";
    for (int c = 0; c < 4; ++c)
      out += std::to_string(71 + c) + "\n" + (i == 1 && c == 0 ? "-" : "") + std::to_string(face[c]) + "\n";
  }
  return dxf(out + "0\nSEQEND\n");
}

inline std::string dxf_mesh() {
  std::string out = "0\nPOLYLINE\n66\n1\n70\n16\n71\n3\n72\n2\n";
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      out += "0\nVERTEX\n" + dxf_point(i, j) + "70\n64\n";
  return dxf(out + "0\nSEQEND\n");
}
