// Files with one tetrahedron each.
#pragma once

#include <string>
#include <utility>
#include <vector>

// One tet in gmsh's format 2.2, with a node and an element to spoil.
inline std::string msh(const std::string& third_node, const std::string& element) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 " + third_node +
         "\n4 0 0 1\n$EndNodes\n$Elements\n1\n1 " + element + "\n$EndElements\n";
}

// The same in gmsh's format 4.1, with one volume.
inline const char* const msh4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n"
    "$EndEntities\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n"
    "0 0 1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";

// The same tet in every format that gmsh reads for us.
inline std::vector<std::pair<std::string, std::string>> one_tet_files() {
  return {
      {"a.msh", msh("0 1 0", "4 2 0 1 1 2 3 4")},
      {"b.msh", msh4},
      {"a.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n"
                 "Tetrahedra\n1\n1 2 3 4 1\nEnd\n"},
      {"a.bdf", "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\n"
                "CTETRA,1,1,1,2,3,4\nENDDATA\n"},
      {"a.unv",
       "    -1\n  2411\n         1         1         1        11\n   0.0D+00   0.0D+00   0.0D+00\n"
       "         2         1         1        11\n   1.0D+00   0.0D+00   0.0D+00\n"
       "         3         1         1        11\n   0.0D+00   1.0D+00   0.0D+00\n"
       "         4         1         1        11\n   0.0D+00   0.0D+00   1.0D+00\n    -1\n    -1\n  2412\n"
       "         1       111         1         1         7         4\n"
       "         1         2         3         4\n    -1\n"},
      {"a.inp", "*Heading\n** one\n*Node\n1, 0, 0, 0\n2, 1., 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
                "*Element, type=C3D4, elset=Rock\n7, 1, 2, 3, 4\n*Elset, elset=all, generate\n7, 7, 1\n"}};
}
