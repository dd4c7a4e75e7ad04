-- Petersson's notched beam in three-point bending (1981): built, bent slowly and watched.
-- Supports at its ends, notch d/2 deep in the middle, d = 0.2 m in the test.
local cdem = require "cdem"

local beam = {}

beam.slenderness = 4 -- span over depth; 10 in the test
beam.notch_ratio = 0.5 -- notch over depth
beam.width = 0.05 -- m
beam.youngs_modulus, beam.poissons_ratio, beam.density = 30e9, 0.2, 2400
beam.strength, beam.fracture_energy = 3.33e6, 124 -- Pa, J/m2

-- Period of the first mode of the beam without its notch, which is simply supported: pi/2 sqrt(E I / (rho A L^4)).
function beam.period(depth)
  local length = beam.slenderness * depth
  return 4 * length ^ 2 / (2 * math.pi * depth) * math.sqrt(12 * beam.density / beam.youngs_modulus)
end

-- A drag of the share `damping` of the first mode's critical one; Cundall's local damping would lean on a beam that is
-- moved steadily.
local function concrete(depth, damping)
  return cdem.elastic{ youngs_modulus = beam.youngs_modulus, poissons_ratio = beam.poissons_ratio,
                       density = beam.density,
                       viscosity = 4 * math.pi * damping * beam.density / beam.period(depth) }
end

-- Cohesion and G_II are high enough to let it fail in tension alone, as the reference solution does.
local function joint(softening, energy)
  return cdem.mohr_coulomb{ cohesion = 3 * beam.strength, friction_angle = 30, tensile_strength = beam.strength,
                            softening = softening, fracture_energy_1 = energy, fracture_energy_2 = 10 * energy }
end

-- The beam, its notch a wedge, so that its tip is one line of nodes. A mesh of few tetrahedra through the width comes
-- with slivers now and then, which cost the time step: the first of some nearly equal sizes that has none is taken.
function beam.mesh(depth, size, coarse, thickness)
  local half, notch, mouth = beam.slenderness * depth / 2, beam.notch_ratio * depth, 0.05 * depth
  local wedge = cdem.convex_hull{ points = {
    {-mouth, -notch, -depth}, {mouth, -notch, -depth}, {0, notch, -depth},
    {-mouth, -notch, 2 * depth}, {mouth, -notch, 2 * depth}, {0, notch, 2 * depth} } }
  local whole = cdem.solid.box{ size = {2 * half, depth, thickness}, origin = {-half, 0, 0} }
  -- A small prism of the same concrete at the top gives the load a line of nodes.
  local a = 0.6 * size
  local prism = cdem.convex_hull{ points = {
    {0, depth, 0}, {2 * a, depth, 0}, {a, depth - a, 0},
    {0, depth, thickness}, {2 * a, depth, thickness}, {a, depth - a, thickness} } }
  local solid = cdem.solid.fragments{ solids = { cdem.solid.cut{ solid = whole, tools = { wedge:solid() } },
                                                 prism:solid() } }
  local best, quality = nil, 0
  for attempt = 0, 9 do
    local mesh = solid:mesh{ size = coarse * (1 - 0.01 * attempt), growth = 0.3, refine = {
      { box = { min = {-0.05 * depth, notch, 0}, max = {0.05 * depth, depth, thickness} }, size = size } } }
    local found = mesh:quality().min_radius_ratio
    if found > quality then best, quality = mesh, found end
    if found > 0.2 then break end
  end
  return best
end

-- given: depth, size, coarse, thickness (m), softening, energy (J/m2), deflection (m), periods (of the first mode that
-- the bending takes), damping, samples, safety, stiffness_ratio, stop_below (ends it at this part of the largest load)
-- and watch (function(model, curve) after each sample).
-- Returns the model and its curve: lists deflection (m), load (N, for the width of the test), mouth (m), elastic,
-- breaking and kinetic (J, likewise); and worst_balance and gap, the largest difference of load and reactions (N).
function beam.bend(given)
  local depth, thickness = given.depth, given.thickness
  local half = beam.slenderness * depth / 2
  local mesh = beam.mesh(depth, given.size, given.coarse, thickness)
  local model = cdem.model{ bodies = { { name = "beam", shape = mesh, material = concrete(depth, given.damping),
                                         joint = joint(given.softening, given.energy), bonds = "cohesive",
                                         stiffness_ratio = given.stiffness_ratio } } }
  local tiny = 1e-6 * depth
  model:select{ name = "left", on = cdem.select.box{ min = {-half - tiny, -tiny, -tiny},
                                                     max = {-half + tiny, tiny, thickness + tiny} } }
  model:select{ name = "right", on = cdem.select.box{ min = {half - tiny, -tiny, -tiny},
                                                      max = {half + tiny, tiny, thickness + tiny} } }
  model:select{ name = "corners", on = function(x, y, z)
    return math.abs(math.abs(x) - half) < tiny and math.abs(y) < tiny and math.abs(z) < tiny
  end }
  model:select{ name = "load", on = cdem.select.box{ min = {-tiny, depth - tiny, -tiny},
                                                     max = {tiny, depth + tiny, thickness + tiny} } }
  model:fix{ on = "left", axes = "xy" }
  model:fix{ on = "right", axes = "y" }
  model:fix{ on = "corners", axes = "z" }

  local curve = { deflection = {0}, load = {0}, mouth = {0}, kinetic = {0}, elastic = {0}, breaking = {0}, time = {0} }
  local deflection, last = 0, 0
  local scale = beam.width / thickness
  local mouth = {0.04 * depth, 1e-3 * depth, thickness / 2}
  -- Means over the time since the last sample, of what presses and what holds: a beam without much damping rings.
  local sum = { support = 0, press = 0, mouth = 0, n = 0 }
  local function listen()
    sum.support = sum.support + model:reaction("left")[2] + model:reaction("right")[2]
    sum.press = sum.press - model:reaction("load")[2]
    sum.mouth = sum.mouth + model:at("displacement.x", mouth) -
                model:at("displacement.x", {-mouth[1], mouth[2], mouth[3]})
    sum.n = sum.n + 1
  end
  local function sample()
    local energy = model:energy()
    local n = #curve.load + 1
    curve.time[n] = model.time
    curve.load[n] = (sum.support + sum.press) / 2 / sum.n * scale
    curve.gap = math.max(curve.gap or 0, math.abs(sum.support - sum.press) / sum.n * scale)
    curve.mouth[n] = sum.mouth / sum.n
    sum = { support = 0, press = 0, mouth = 0, n = 0 }
    curve.kinetic[n], curve.elastic[n] = energy.kinetic * scale, (energy.elastic + energy.springs) * scale
    curve.breaking[n] = energy.breaking * scale
    curve.peak = math.max(curve.peak or 0, curve.load[n])
    curve.worst_balance = math.max(curve.worst_balance or 0, energy.balance_error)
  end

  -- Smooth start: the velocity grows with sin^2 over the first 0.4 of the time, in steps.
  local duration = given.periods * beam.period(depth) -- s
  local ramp, steps = 0.4, 40
  local full = given.deflection / (duration * (1 - ramp / 2))
  local samples = given.samples or 120
  local function advance(velocity, time)
    model:fix{ on = "load", axes = "y", velocity = {0, -velocity, 0} }
    model:run{ duration = time, safety = given.safety, every = 25, callback = listen }
    curve.deflection[#curve.deflection + 1] = deflection + velocity * time / 2 -- of the mean
    deflection = deflection + velocity * time
    sample()
    if given.watch then given.watch(model, curve) end
    last = curve.load[#curve.load]
  end
  for i = 1, steps do
    advance(full * math.sin(math.pi / 2 * (i - 0.5) / steps) ^ 2, duration * ramp / steps)
  end
  for _ = 1, samples do
    if last < (given.stop_below or -math.huge) * curve.peak then break end
    advance(full, duration * (1 - ramp) / samples)
  end
  return model, curve
end

-- Largest load of the mean over five samples, which takes out the ringing.
function beam.peak(curve)
  local top = 0
  for k = 3, #curve.load - 2 do
    local sum = 0
    for j = k - 2, k + 2 do sum = sum + curve.load[j] end
    top = math.max(top, sum / 5)
  end
  return top
end

return beam
