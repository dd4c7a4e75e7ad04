-- Han 2010, example 4.2: an off-centre notch in a beam in bending; the crack grows to the load.
--
--   ./cdem run examples/notched_beam/case.lua [--set passes=3] [--set support=roller] [--set mesh=voronoi]
local cdem = require "cdem"
local beam = require "beam"
local crack = require "path"

local load = cdem.parameter{ name = "load", default = 2.5e4, range = {0, 1e9}, unit = "N", doc = "downward, at mid-span" }
local passes = cdem.parameter{ name = "passes", default = 40, range = {0, 1000}, doc = "at most; the paper's three: 3" }
local support = cdem.parameter{ name = "support", default = "pinned", choices = beam.supports,
                                doc = "bottom end edges, the same with one free along x, or 0.03 m of the bottom at each end" }
local mesh = cdem.parameter{ name = "mesh", default = "41x10", choices = beam.meshes,
                             doc = "blocks: a grid, a grid turned by 15 degrees, or 400 Voronoi cells" }
local seed = cdem.parameter{ name = "seed", default = 1, range = {0, 1000000}, doc = "of the Voronoi cells" }
local anchored = cdem.parameter{ name = "anchored", default = true, doc = "one cut plane passes through the tip" }
local judged_by = cdem.parameter{ name = "judged_by", default = "tip", choices = {"tip", "block"},
                                  doc = "what turns the planes: the stress around the tip, or each block's own mean" }
local tip_radius = cdem.parameter{ name = "tip_radius", default = 0.0, range = {0, 1}, unit = "m",
                                   doc = "reach of the stress around the tip; 0: one block size" }
local thickness_ratio = cdem.parameter{ name = "thickness_ratio", default = 0.02, range = {1e-4, 1},
                                        doc = "of the joints, over the block size" }

local joint = cdem.mohr_coulomb{ cohesion = 10e6, friction_angle = 30, tensile_strength = 2e6,
                                 thickness_ratio = thickness_ratio }
local model = beam.model({ { shape = beam.shape(mesh, seed), material = beam.rock, joint = joint, name = "beam",
                             element = "small_strain" } }, support)
model:force{ on = "load line", force = {0, -load, 0} }

model:relax{ residual = 1e-6, breaking = false }
local midspan = model:at("displacement.y", {beam.midspan, 1e-6, beam.depth / 2})

-- A ParaView frame of every pass, pictures of the paper's three and of the end.
local function picture(name, title) model:picture{ file = name .. ".png", title = title, size = {1600, 0} } end

local growth = { state = "not loaded", passes = {} }
if passes > 0 then
  growth = model:grow{ passes = passes, anchor_at_tip = anchored, judged_by = judged_by,
                       tip_radius = tip_radius > 0 and tip_radius or nil, callback = function(pass)
    local name = "pass_" .. pass.pass
    model:save{ file = name .. ".vtu", series = "beam.pvd" }
    if pass.pass <= 3 then picture(name, "Crack after pass " .. pass.pass) end
  end }
  picture("crack", "Crack at the end")
end

local first, last = growth.passes[1], growth.passes[#growth.passes]
local path = last and last.path or {}
local rms_to_hoop_stress = #path > 1 and crack.distance(path, beam.hoop_stress_path[support]) or nil
local rms, heights = crack.rms_to_points(path, beam.reference)

if #path > 0 then
  local x, y, line, trial, hoop = {}, {}, {}, {}, {}
  for i, p in ipairs(path) do x[i], y[i], line[i] = p[1], p[2], {p[1], p[2], beam.depth} end
  for i, p in ipairs(beam.reference) do trial[i] = {p[1], p[2], beam.depth} end
  for i, p in ipairs(beam.hoop_stress_path[support]) do hoop[i] = {p[1], p[2], beam.depth} end
  cdem.write_csv{ file = "path.csv", columns = { { name = "x_m", values = x }, { name = "y_m", values = y } } }
  model:picture{ file = "ux.png", colour = "displacement.x", deformation = 200, title = "Horizontal displacement",
                 size = {1600, 0}, broken_bonds = false }
  model:picture{ file = "path.png", title = "Path of the crack", size = {1600, 0}, broken_bonds = false,
                 lines = { { points = line, label = "cdem", colour = {0.75, 0, 0.38} },
                           { points = hoop, label = "largest hoop stress", colour = {0, 0, 0}, dashed = true },
                           { points = trial, label = "reference points", colour = {0, 0.38, 0.75}, dashed = true } } }
end

local paper = load == 2.5e4 or nil
-- A support along a line yields without end as the mesh gets finer, so the first two references drift with their mesh.
local elastic = { pinned = { -4.1e-4, "finite elements of 12 mm; -4.35e-4 with 4 mm at the supports" },
                  roller = { -7.03e-4, "finite elements of 12 mm; -7.34e-4 with 4 mm at the supports" },
                  face = { -3.136e-4, "finite elements", mesh == "41x10" and 0.02 or nil } }
-- Only for a crack that has stopped by itself.
local end_of_hoop_stress = paper and growth.state == "arrested" and
                           beam.hoop_stress_path[support][#beam.hoop_stress_path[support]] or {}
cdem.report{
  { name = "crack_tip_x_m", value = last and last.tip[1], unit = "m", reference = end_of_hoop_stress[1], kind = "fe",
    source = "end of the path of the largest hoop stress" },
  { name = "crack_tip_y_m", value = last and last.tip[2], unit = "m", reference = end_of_hoop_stress[2], kind = "fe",
    source = "end of the path of the largest hoop stress" },
  { name = "path_rms_to_reference_m", value = rms, unit = "m", reference = 0, kind = "trial",
    source = "horizontal distance at the heights of " .. heights .. " of " .. #beam.reference .. " reference points" },
  { name = "path_rms_to_hoop_stress_m", value = rms_to_hoop_stress, unit = "m", reference = 0, kind = "fe",
    source = "largest hoop stress at the tip of a crack in finite elements, distance to the nearest place" },
  { name = "passes", value = #growth.passes, source = growth.state },
  { name = "load_that_starts_the_crack_N", value = first and first.first_ratio > 0 and load / first.first_ratio or nil,
    unit = "N", source = "load over the ratio of the first face's traction to its strength; the beam is linear until then" },
  { name = "elastic_midspan_uy_m", value = midspan, unit = "m", reference = paper and elastic[support][1], kind = "fe",
    source = elastic[support][2], tolerance = paper and elastic[support][3] },
  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 0.01 },
  { name = "steps", value = model.steps },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
