-- Which change of the shape, the hold or the load lets the set-ups of Feng 2014 section 3 break at the waist or the top? Coarse
-- meshes, hold.
--
--   ./cdem run examples/armour_unit/shapes.lua [--set cases=2,4,6] [--set fineness=6]
local cdem = require "cdem"
local unit = require "unit"

local cases = cdem.parameter{ name = "cases", default = {2, 4, 6}, range = {1, 6}, doc = "set-ups" }
local fineness = cdem.parameter{ name = "fineness", default = 5.0, range = {3, 60}, doc = "height over edge of the tets" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 100.0, range = {1, 1e6}, unit = "J/m2" }
local draw = cdem.parameter{ name = "pictures", default = false, doc = "of each unit as it breaks" }
local only = cdem.parameter{ name = "only", default = "all", doc = "one of the changes" }

-- hold: share of the extent from the held side that is fixed, the side alone at 0; load: outer faces that take the flow, those
-- of one side or of the third that is farthest from the held side; above: other proportions of the upper half.
local thin_bars = { core = 0.28, bar = 0.20 } -- bars that are free over 1.8 times their depth, once as long as deep
local changes = {
  { name = "unchanged" },
  { name = "thin_core", shape = { core = 0.28 } },
  { name = "narrow", shape = { width = 0.28 } },
  { name = "thin_tips", shape = { taper = 0.55 } },
  { name = "long_nose", shape = { length = 1.2 } },
  { name = "held_to_a_quarter", hold = 0.25 },
  { name = "held_to_a_third", hold = 0.34 },
  { name = "held_to_a_quarter_thin_core", shape = { core = 0.28 }, hold = 0.25 },
  { name = "load_on_the_side", load = "side" },
  { name = "held_to_a_half", hold = 0.5 },
  { name = "held_to_a_half_thin_bars", shape = thin_bars, hold = 0.5 },
  { name = "load_on_the_top", load = "top" },
  { name = "load_on_the_top_held_to_a_half", load = "top", hold = 0.5 },
  { name = "thin_bars_above", above = thin_bars },
  { name = "thinner_bars_above", above = { core = 0.28, bar = 0.15 } },
}
local concrete = cdem.elastic{ youngs_modulus = unit.youngs_modulus, poissons_ratio = unit.poissons_ratio,
                               density = unit.density }
local joint = cdem.mohr_coulomb{ cohesion = unit.cohesion, friction_angle = unit.friction_angle,
                                 tensile_strength = unit.tensile_strength, softening = "linear",
                                 fracture_energy_1 = toughness, fracture_energy_2 = 10 * toughness }
local axis_of = { x = 1, y = 2, z = 3 }
local figures = {}
for _, change in ipairs(changes) do
  if only == "all" or only == change.name then
    local settings = { mass = 5000, density = unit.density, shape = "stocky" }
    for key, value in pairs(change.shape or {}) do settings[key] = value end
    local solid = cdem.accropode(settings)
    local height = solid.height
    if change.above then
      local H = height
      local upper = cdem.accropode{ height = H, shape = "stocky", core = change.above.core, bar = change.above.bar }
      local function half(of, z)
        return cdem.solid.common{ solid = of, other = cdem.solid.box{ size = {2 * H, 2 * H, H}, origin = {-H, -H, z} } }
      end
      solid = cdem.solid.union{ solids = { half(solid, -H), half(upper, 0) } }
    end
    local mesh = solid:mesh{ size = height / fineness }
    local box = mesh:box()
    for _, number in ipairs(cases) do
      local case = unit.cases[number]
      local model = cdem.model{ bodies = { { shape = mesh, material = concrete, joint = joint, bonds = "cohesive",
                                             name = "unit" } } }
      local axis = axis_of[case.held:sub(1, 1)]
      local function part(from, to) -- between two shares of the extent from the held side
        local low, high = {}, {}
        for i = 1, 3 do low[i], high[i] = box.min[i], box.max[i] end
        low[axis] = box.min[axis] + from * (box.max[axis] - box.min[axis])
        high[axis] = box.min[axis] + to * (box.max[axis] - box.min[axis])
        return cdem.select.box{ min = low, max = high }
      end
      local held = change.hold and part(0, change.hold) or case.held
      model:fix{ on = held }
      local side = case.flow[1] > 0 and "x-" or case.flow[2] > 0 and "y-" or "z-"
      local broken = model:critical_flow{ direction = case.flow, mode = "hold", held = case.held,
                                          on = change.load == "side" and side or change.load == "top" and part(2 / 3, 1)
                                               or "all" }
      local key = string.format("%s_%d_", change.name, number)
      if draw then
        local most = model:max("displacement.magnitude")
        model:picture{ file = key .. "breaks.png", colour = "displacement.magnitude", camera = unit.camera(case, height, 2.9),
                       axes = false, deformation = most > 0 and math.floor(0.1 * height / most) or 0,
                       title = string.format("Case %d, %s: broken at %.1f m/s", number, change.name:gsub("_", " "),
                                             broken.velocity) }
      end
      figures[#figures + 1] = { name = key .. "m_per_s", value = broken.velocity, unit = "m/s", reference = case.velocity,
                                kind = "paper", source = "Feng 2014 table 2; ended by " .. broken.reason }
      figures[#figures + 1] = { name = key .. "place", value = unit.place(broken, case), reference = case.place, kind = "paper",
                                source = "Feng 2014 section 3.3, in words" }
      figures[#figures + 1] = { name = key .. "height_fraction", value = broken.height_fraction }
    end
  end
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
