-- Brazilian test: a disc of rock is pressed across its diameter between two platens until it splits. It has two flat ends under
-- the platens, so that the crack begins in the middle; a round disc is crushed at its ends first.
--
--   ./cdem run examples/brazilian_disc/case.lua [--set arc=0] [--set size=1.6e-3] [--set fracture_energy=40]
local cdem = require "cdem"

local size = cdem.parameter{ name = "size", default = 2.2e-3, range = {5e-4, 1e-2}, unit = "m", doc = "edge of the tetrahedra" }
local arc = cdem.parameter{ name = "arc", default = 20.0, range = {0, 40}, unit = "deg", doc = "of a flat end; 0: a round disc" }
local speed = cdem.parameter{ name = "speed", default = 0.1, range = {1e-3, 10}, unit = "m/s", doc = "of the upper platen" }
local energy = cdem.parameter{ name = "fracture_energy", default = 20.0, range = {1, 1e5}, unit = "J/m2", doc = "G_I" }
local pictures = cdem.parameter{ name = "pictures", default = true, doc = "draw them" }

local D, t = 0.05, 0.025 -- m, diameter and thickness
local T, cohesion, phi = 8e6, 24e6, 40 -- Pa, Pa, deg
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2600 }
local joint = cdem.mohr_coulomb{ cohesion = cohesion, friction_angle = phi, tensile_strength = T, softening = "linear",
                                 fracture_energy_1 = energy, fracture_energy_2 = 10 * energy }
local alpha = math.rad(arc / 2)
local foot = D / 2 * (1 - math.cos(alpha)) -- m, height of what is cut off at each end
local disc = cdem.solid.cylinder{ radius = D / 2, axis = {0, t, 0}, base = {0, 0, D / 2} }
local function platen(z) return cdem.solid.box{ size = {D, 2 * t, 0.1 * D}, origin = {-D / 2, -t / 2, z} } end
local lower, upper = platen(foot - 0.1 * D), platen(D - foot)
if arc > 0 then disc = cdem.solid.cut{ solid = disc, tools = {lower, upper} } end
local model = cdem.model{
  bodies = { { name = "disc", shape = disc:mesh{ size = size }, material = rock, joint = joint },
             { name = "lower", shape = lower:mesh{ size = D }, material = rock, element = "rigid" },
             { name = "upper", shape = upper:mesh{ size = D }, material = rock, element = "rigid" } },
  contacts = { default = cdem.coulomb{ friction_angle = 25 } } }
model:fix{ on = "lower" }
model:fix{ on = "upper", velocity = {0, 0, -speed}, amplitude = { {0, 0}, {0.002 * D / speed, 1} } }

-- The upper platen comes down until the force has fallen to half of its peak.
local near = 0.05 * D
local middle = cdem.select.box{ min = {-near, -t, D / 2 - near}, max = {near, 2 * t, D / 2 + near} }
local way, force, across, along, peak = {}, {}, {}, {}, 1
model:run{ duration = 0.02 * D / speed, every = 20, stop = function()
  local n = #force + 1
  force[n] = (model:reaction("lower")[3] - model:reaction("upper")[3]) / 2
  way[n] = -model:mean("displacement.z", "upper")
  across[n], along[n] = model:mean("stress.xx", middle), model:mean("stress.zz", middle)
  if force[n] > force[peak] then peak = n end
  return force[peak] > 0.1 * T * D * t and force[n] < 0.5 * force[peak]
end }

-- Two forces P on a diameter give 2 P / (pi D t) across it and three times as much pressure along it (Hertz 1883). The pressure
-- of a rigid punch on ends of the half angle alpha takes 2 sin(alpha)^2 off both factors.
local unit, less = math.pi * D * t / 2, 2 * math.sin(alpha) ^ 2 -- m2, 1
local sums = { force = 0, across = 0, along = 0 } -- from a quarter to a half of the peak, where the middle is whole
for i = 1, peak do
  if force[i] > 0.25 * force[peak] and force[i] < 0.5 * force[peak] then
    sums.force, sums.across, sums.along = sums.force + force[i], sums.across + across[i], sums.along + along[i]
  end
end
local tension, last = {}, way[#way]
for i, P in ipairs(force) do tension[i] = (1 - less) * P / unit end
if pictures then
  model:picture{ file = "split.png", title = "Split, displacements five times larger", colour = "displacement.x", up = "z",
                 deformation = 5, plain = {"lower", "upper"} }
end
cdem.chart{ file = "force.png", title = "Brazilian test", x_label = "way of the platen (m)", y_label = "stress (Pa)", series = {
  { name = "of the force, by the formula", x = way, y = tension }, { name = "across, in the middle", x = way, y = across },
  { name = "tensile strength", x = {0, last}, y = {T, T}, style = "dashed", colour = {0, 0, 0} } } }
cdem.write_csv{ file = "curve.csv", columns = { { name = "way_m", values = way }, { name = "force_N", values = force },
                                                { name = "stress_across_Pa", values = across },
                                                { name = "stress_along_Pa", values = along } } }
local counts = model:counts()
cdem.report{
  { name = "tetrahedra", value = counts.tets },
  { name = "stress_across_over_2P_by_pi_D_t", value = sums.across * unit / sums.force, reference = 1 - less, tolerance = 0.08,
    kind = "formula", source = "Hertz 1883; ends as under a rigid punch" },
  { name = "pressure_along_over_2P_by_pi_D_t", value = -sums.along * unit / sums.force, reference = 3 - less, tolerance = 0.08,
    kind = "formula", source = "Hertz 1883; ends as under a rigid punch" },
  { name = "strength_over_tensile_strength", value = tension[peak] / T, reference = 1, tolerance = 0.1, kind = "formula",
    source = "the middle bears T" },
  { name = "broken_in_tension", value = counts.broken_tension },
  { name = "broken_in_shear", value = counts.broken_shear },
  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 0.01 },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
