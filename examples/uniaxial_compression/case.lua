-- Han 2010, example 4.1: a rock plate under uniaxial compression fails in an X.
--
--   ./cdem run examples/uniaxial_compression/case.lua [--set pressure=24e6] [--set divisions=20]
--   ./cdem run examples/uniaxial_compression/case.lua --set until_stage=collapse
local cdem = require "cdem"
local collapse = require "collapse"

local pressure = cdem.parameter{ name = "pressure", default = 30e6, range = {0, 1e9}, unit = "Pa", doc = "on the top face" }
local divisions = cdem.parameter{ name = "divisions", default = 10, range = {2, 100}, doc = "blocks along a side" }
local thickness_ratio = cdem.parameter{ name = "thickness_ratio", default = 0.02, range = {1e-4, 1},
                                        doc = "equivalent thickness L of a joint over the block size h" }
local shear_threshold = cdem.parameter{ name = "shear_threshold", default = 0.7e6, range = {0, 1e8}, unit = "Pa",
                                        doc = "blocks this close to the Mohr-Coulomb line are cut" }
local until_stage = cdem.parameter{ name = "until_stage", default = "failure", choices = {"elastic", "failure", "collapse"} }

local size, depth = 0.3, 0.3 / divisions -- m
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 8e6, friction_angle = 30, tensile_strength = 5e6, thickness_ratio = thickness_ratio }
local plate = cdem.grid{ size = {size, size, depth}, divisions = {divisions, divisions, 1} }

local model, on
if until_stage == "collapse" then
  model, on = collapse.model{ plate = plate, rock = rock, joint = joint }
else
  model = cdem.model{ bodies = { { shape = plate, material = rock, joint = joint, name = "plate",
                                   element = "small_strain" } } }
  on = { back = "z-", front = "z+", bottom = "y-", top = "y+" }
end
model:fix{ on = {on.back, on.front}, axes = "z" }
model:fix{ on = on.bottom, axes = "xyz" }
model:fix{ on = on.top, axes = "xz" }
model:traction{ on = on.top, stress = {0, -pressure, 0} }

-- Elastic balance, then cut the blocks that are near failure.
model:relax{ residual = 1e-6, breaking = false }
local elastic_top = model:mean("displacement.y", on.top)
local elastic_side = model:at("displacement.x", {size, size / 2, depth / 2})
if until_stage == "elastic" then
  cdem.report{ { name = "elastic_top_uy_mean_m", value = elastic_top, unit = "m" },
               { name = "elastic_side_ux_m", value = elastic_side, unit = "m" } }
  return
end
local cuts = model:refine{ shear_threshold = shear_threshold }
model:relax{ residual = 1e-6, breaking = false }
model:picture{ file = "cuts.png", title = "Blocks cut along their failure planes", broken_bonds = false }
model:save{ file = "cut.vtu", series = "plate.pvd" }

-- Let the bonds break.
local failure = model:relax{ residual = 1e-5, breaking = true }
if until_stage == "collapse" then return collapse.run(model, on) end
model:save{ file = "failed.vtu", series = "plate.pvd" }
model:picture{ file = "ux.png", colour = "displacement.x", deformation = 20, broken_bonds = false,
               title = "Horizontal displacement after failure" }
model:picture{ file = "broken.png", deformation = 20, title = "Broken bonds" }
model:chart{ file = "history.png", title = "From balance to failure and back", y = {"residual"}, log_y = true,
             y_label = "out-of-balance force / load", right = {"broken_tension", "broken_shear"},
             right_label = "broken springs" }

-- Figures beside their references.
local low, high = 90, 0
for _, cut in ipairs(cuts) do
  local from_vertical = math.deg(math.atan(math.abs(cut.normal[2]), math.abs(cut.normal[1])))
  low, high = math.min(low, from_vertical), math.max(high, from_vertical)
end

-- How far the displacement is from its own mirror image, over block centres.
local function mirror_error()
  local image, largest, worst = {}, 0, 0
  local function key(x, y) return string.format("%.6f %.6f", x, y) end
  local blocks = model:blocks()
  for _, b in ipairs(blocks) do
    image[key(b.centroid[1], b.centroid[2])] = b.displacement[1]
    largest = math.max(largest, math.abs(b.displacement[1]))
  end
  for _, b in ipairs(blocks) do
    local other = image[key(size - b.centroid[1], b.centroid[2])]
    worst = math.max(worst, other and math.abs(b.displacement[1] + other) or math.huge)
  end
  return largest > 0 and worst / largest or 0
end

local cut_any = #cuts > 0 or nil
local paper_case = pressure == 30e6 and divisions == 10 and thickness_ratio == 0.02 and shear_threshold == 0.7e6 or nil
local function trial(value) return paper_case and value end

cdem.report{
  { name = "blocks_cut_first_pass", value = #cuts, reference = trial(56), kind = "trial" },
  { name = "cut_angle_min_deg", value = cut_any and low, unit = "deg", reference = trial(29), kind = "trial",
    source = "from vertical; Mohr-Coulomb in a uniform field: 30" },
  { name = "cut_angle_max_deg", value = cut_any and high, unit = "deg", reference = trial(33), kind = "trial",
    source = "from vertical; Mohr-Coulomb in a uniform field: 30" },
  { name = "elastic_top_uy_mean_m", value = elastic_top, unit = "m", reference = -2.7375e-4 * pressure / 30e6, kind = "fe",
    source = "fine finite-element mesh, no joints", tolerance = 0.02 },
  { name = "elastic_side_ux_m", value = elastic_side, unit = "m", reference = 4.665e-5 * pressure / 30e6, kind = "fe",
    source = "fine finite-element mesh, no joints", tolerance = 0.02 },
  { name = "wedge_ux_max_m", value = model:max("displacement.x"), unit = "m", reference = trial(0.45e-3), kind = "trial" },
  { name = "final_top_uy_mean_m", value = model:mean("displacement.y", on.top), unit = "m",
    reference = trial(-5.06e-4), kind = "trial" },
  { name = "bonds_broken_tension", value = failure.broken_tension, source = "spring points" },
  { name = "bonds_broken_shear", value = failure.broken_shear, source = "spring points" },
  { name = "mirror_error_ux", value = mirror_error(), reference = 0, kind = "formula", source = "the case is symmetric",
    tolerance_absolute = 0.01 },
  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 0.01 },
  { name = "residual", value = failure.residual, reference = 0, kind = "formula", source = "static balance",
    tolerance_absolute = 1e-5 },
  { name = "steps", value = model.steps, reference = trial(41600), kind = "trial" },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s", reference = trial(36), kind = "trial" },
}
