// A meshed body of cdem.model: its element, and what holds its tetrahedra together.
#pragma once

#include "lua/binding/schema/schema.hpp"
#include "lua/binding/session/session.hpp"

#include "libcdem/simulation.hpp"

namespace cdem::script {

// path: "bodies[2]", for messages. With a joint it may break.
void read_mesh(Session&, const Arguments& given, const std::string& path, std::vector<geom::TetMesh> meshes,
               BodySpec& body);

} // namespace cdem::script
