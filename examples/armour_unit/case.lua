-- Feng 2014, section 3: one armour unit of 5 t, held on one side, is broken by a rising flow. Six set-ups.
--
--   ./cdem run examples/armour_unit/case.lua [--set case=2] [--set mode=hold] [--set fineness=13]
local cdem = require "cdem"
local unit = require "unit"

local number = cdem.parameter{ name = "case", default = 1, range = {1, 6}, doc = "set-up of the paper's Fig 3" }
local mode = cdem.parameter{ name = "mode", default = "both", choices = {"both", "hold", "ramp"},
                             doc = "hold: near the static strength; ramp: the pressure rises all the time" }
local shape = cdem.parameter{ name = "shape", default = "stocky", choices = {"slender", "stocky"} }
local mass = cdem.parameter{ name = "mass", default = 5000.0, range = {1, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 16.5, range = {3, 60},
                                 doc = "height over the edge length of the tetrahedra" }
local tension = cdem.parameter{ name = "tensile_strength", default = unit.tensile_strength, range = {1, 1e9}, unit = "Pa" }
local cohesion = cdem.parameter{ name = "cohesion", default = unit.cohesion, range = {1, 1e9}, unit = "Pa" }
local rate = cdem.parameter{ name = "pressure_rate", default = 5e6, range = {1, 1e12}, unit = "Pa/s" }
local damping = cdem.parameter{ name = "local_damping", default = 0.1, range = {0, 0.9} }
local bonds = cdem.parameter{ name = "bonds", default = "springs", choices = {"springs", "cohesive"},
                              doc = "springs on every face, as in the paper, or a continuous unit that cracks" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 0.0, range = {0, 1e6}, unit = "J/m2",
                                  doc = "G_I of a cohesive unit, G_II ten times that; 0: brittle" }
local beta = cdem.parameter{ name = "stiffness_ratio", default = bonds == "springs" and 10.0 or 1.0, range = {0.1, 1000},
                             doc = "of the bonds, beta" }
local draw = cdem.parameter{ name = "pictures", default = true, doc = "draw them" }

local case = unit.cases[number]
local concrete = cdem.elastic{ youngs_modulus = unit.youngs_modulus, poissons_ratio = unit.poissons_ratio,
                               density = unit.density }
local tough = toughness > 0
local joint = cdem.mohr_coulomb{ cohesion = cohesion, friction_angle = unit.friction_angle, tensile_strength = tension,
                                 softening = tough and "linear" or "none",
                                 fracture_energy_1 = tough and toughness or nil,
                                 fracture_energy_2 = tough and 10 * toughness or nil }
-- The mesh is that of 5 t, scaled: another size has the same tetrahedra, and what differs is not the mesh.
local solid = cdem.accropode{ mass = 5000, density = unit.density, shape = shape }
local mesh = solid:mesh{ size = solid.height / fineness }
local scale = (mass / 5000) ^ (1 / 3)
local height = solid.height * scale
if mass ~= 5000 then
  mesh:save{ file = "unit_of_5_t.vtu" }
  mesh = cdem.read_mesh{ file = "unit_of_5_t.vtu", scale = scale }
end
local quality = mesh:quality()

if draw then
  mesh:picture{ file = "setup.png", camera = unit.camera(case, height, 2.85, 0.09),
                title = unit.title(number), lines = unit.set_up(case, height, mesh:box()) }
end

local figures, energy_error, steps = {}, 0, 0
for _, how in ipairs(mode == "both" and {"hold", "ramp"} or {mode}) do
  local model = cdem.model{ bodies = { { shape = mesh, material = concrete, joint = joint, bonds = bonds,
                                         stiffness_ratio = beta, name = "unit" } } }
  model:fix{ on = case.held }
  local broken = model:critical_flow{ direction = case.flow, mode = how, held = case.held, pressure_rate = rate,
                                      local_damping = damping }

  local columns = {}
  for _, name in ipairs{ "time", "pressure", "velocity", "displacement", "broken" } do
    local values = {}
    for i, sample in ipairs(broken.curve) do values[i] = sample[name] end
    columns[#columns + 1] = { name = name, values = values }
  end
  cdem.write_csv{ file = how .. "_curve.csv", columns = columns }
  model:save{ file = how .. ".vtu" }
  if draw then
    local most = model:max("displacement.magnitude")
    local view = { camera = unit.camera(case, height, 2.9), axes = false,
                   deformation = most > 0 and math.floor(0.1 * height / most) or 0,
                   title = string.format("Case %d, %s: broken at %.1f m/s", number, how, broken.velocity) }
    view.file, view.colour = how .. ".png", "displacement.magnitude"
    model:picture(view)
    view.file, view.colour, view.opacity = how .. "_cracks.png", nil, 0.3 -- cracks inside show through
    model:picture(view)
  end

  local prefix = "case_" .. number .. "_"
  local paper = mass == 5000 and case.velocity or nil
  figures[#figures + 1] = { name = prefix .. how .. "_m_per_s", value = broken.velocity, unit = "m/s", reference = paper,
                            kind = "paper",
                            source = "Feng 2014 table 2, without ramp rate or criterion; ended by " .. broken.reason }
  figures[#figures + 1] = { name = prefix .. "first_break_" .. how .. "_m_per_s", value = broken.first_break_velocity,
                            unit = "m/s", reference = number == 1 and shape == "stocky" and unit.beam_velocity(tension) or nil,
                            kind = "formula", source = "beam theory at the root of set-up 1" }
  figures[#figures + 1] = { name = prefix .. (how == "hold" and "place" or "place_ramp"), value = unit.place(broken, case),
                            reference = case.place, kind = "paper", source = "Feng 2014 section 3.3, in words" }
  figures[#figures + 1] = { name = prefix .. how .. "_height_fraction", value = broken.height_fraction }
  figures[#figures + 1] = { name = prefix .. how .. "_period_s", value = broken.period, unit = "s" }
  figures[#figures + 1] = { name = prefix .. how .. "_bonds_broken", value = broken.broken_tension + broken.broken_shear }
  energy_error = math.max(energy_error, model:energy().balance_error)
  steps = steps + broken.steps
end

local more = {
  { name = "tets", value = quality.tets, reference = mass == 5000 and 9817 or nil, kind = "paper", source = "their mesh" },
  { name = "nodes", value = quality.nodes, reference = mass == 5000 and 2141 or nil, kind = "paper", source = "their mesh" },
  { name = "min_radius_ratio", value = quality.min_radius_ratio },
  { name = "principal_inertia_ratio_max", value = mesh:inertia{}.principal_ratio,
    source = "of the unit's shape: 1 would be no preferred direction" },
  { name = "energy_balance_error", value = energy_error, reference = 0, kind = "formula", source = "energy is conserved",
    tolerance_absolute = 0.01 },
  { name = "steps", value = steps },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
for _, figure in ipairs(more) do figures[#figures + 1] = figure end
cdem.report(figures)
