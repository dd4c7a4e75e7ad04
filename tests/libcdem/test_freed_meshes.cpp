// Freeing and joining nodes finds what is new around these nodes alone, and the model is that which a whole build gives.
#include "libcdem/element/mesh_fields.hpp"
#include "libcdem/element/small_strain.hpp"
#include "libcdem/fracture/split_nodes.hpp"
#include "libcdem/integrate/row_sums.hpp"
#include "libcdem/model/build/contact_surface.hpp"
#include "libcdem/model/build/freed_meshes.hpp"
#include "libcdem/model/known_of_model.hpp"
#include "libgeom/mesh/box_mesh.hpp"
#include "tests/libcdem/cohesive_concrete.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace testing;

namespace {

// All blocks, which are meshes, built from their seeds.
cdem::Model built_whole(const cdem::Model& model) {
  cdem::Model whole = model;
  std::vector<cdem::MeshSeed> seeds;
  for (int block = 0; block < static_cast<int>(model.blocks.size()); ++block)
    seeds.push_back(cdem::mesh_seed(model, block));
  whole.blocks.clear();
  whole.node_position.clear();
  whole.node_mass.clear();
  whole.gravitational_mass.clear();
  whole.tets.clear();
  whole.tet_block.clear();
  whole.outer_faces.clear();
  whole.chunks.clear();
  whole.mesh = {};
  cdem::start_meshes(whole);
  cdem::add_meshes(whole, std::move(seeds));
  cdem::build_surface(whole);
  return whole;
}

std::vector<double> rows_of_whole(const cdem::Model& model) {
  std::vector<double> sums = cdem::stiffness_row_sums(model);
  cdem::add_mesh_row_sums(model, sums);
  return sums;
}

// Some nodes, with all their copies.
std::vector<char> drawn(const cdem::Model& model, std::mt19937& draw, double part) {
  std::uniform_real_distribution<double> uniform;
  std::vector<char> of_original(model.node_position.size(), 0), nodes(of_original.size(), 0);
  for (char& chosen : of_original)
    chosen = static_cast<char>(uniform(draw) < part);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = of_original[model.mesh.original[i]];
  return nodes;
}

cdem::BodySpec in_regions(cdem::BodySpec body) {
  for (std::size_t t = 0; t < body.meshes[0].tets.size(); ++t)
    body.meshes[0].region[t] = body.meshes[0].nodes[body.meshes[0].tets[t][0]].x() < 0.25 ? 0 : 1;
  return body;
}

} // namespace

TEST_CASE("freed nodes: the model and its row sums are those of a whole build, also where nodes are joined",
          "[cohesive][joined]") {
  const std::string kind =
      GENERATE("everywhere", "between regions", "around a region", "scattered", "regions");
  cdem::BodySpec body = concrete_body(geom::box_mesh({0.5, 0.4, 0.4}, {7, 6, 6}));
  if (kind != "everywhere" && kind != "scattered")
    body = in_regions(std::move(body));
  if (kind == "between regions" || kind == "around a region")
    body.bonding.everywhere = false;
  if (kind == "between regions")
    body.bonding.between_regions = true;
  if (kind == "around a region")
    body.bonding.regions = {1};
  if (kind == "scattered") {
    body.joint.scatter.modulus = 8;
    body.joint.scatter.reference_volume = 1e-3;
  }
  if (kind == "regions") {
    body.region_laws.joints = {body.joint};
    body.region_laws.joints[0].cohesion *= 0.9;
    body.region_laws.regions = {{0, 1}};
  }
  cdem::BodySpec beside = meshed("beside", geom::box_mesh({0.2, 0.2, 0.2}, {2, 2, 2}), [] {
    cdem::Bonding springs;
    springs.everywhere = true;
    return springs;
  }());
  for (geom::Vec3& x : beside.meshes[0].nodes)
    x.x() += 1;
  cdem::Model model = build({body, beside}, {{"concrete", "concrete", friction(30)}});
  cdem::State state = cdem::initial_state(model);
  std::mt19937 draw(3);
  std::size_t most = 0;
  for (const double part : {0.02, 0.1, -0.5, 0.3, -0.3, -1.0}) {
    INFO(kind << " " << part);
    const std::vector<char> nodes = drawn(model, draw, std::abs(part));
    cdem::element_row_sums(model);
    cdem::Freed now =
        part > 0 ? cdem::split_nodes(model, state, nodes) : cdem::join_nodes(model, state, nodes);
    CHECK(cdem::fingerprint(now.model) == cdem::fingerprint(built_whole(now.model)));
    cdem::renew_row_sums(model, now.model, now.old_node, now.tets);
    CHECK(cdem::element_row_sums(now.model) == rows_of_whole(now.model));
    model = std::move(now.model);
    state = std::move(now.state);
    most = std::max(most, model.mesh.faces.size());
  }
  CHECK(most > (kind == "between regions" ? 10 : 60));
}
