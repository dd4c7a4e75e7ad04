-- A pressure pulse runs through a bar, comes back from the free end as tension and tears a slab off. Place, time and velocity
-- stand beside the theory of waves in a bar.
--
--   ./cdem run examples/spall/case.lua [--set cells=400] [--set peak=5e6]
local cdem = require "cdem"

local cells = cdem.parameter{ name = "cells", default = 200, range = {50, 800}, doc = "along the bar" }
local peak = cdem.parameter{ name = "peak", default = 6e6, range = {4.5e6, 7.5e6}, unit = "Pa", doc = "of the pulse" }
local G = cdem.parameter{ name = "G", default = 4.0, range = {1, 100}, unit = "J/m2", doc = "fracture energy" }

-- Concrete without lateral strain: its bar carries plane waves.
local E, density, T = 30e9, 2400, 4e6
local c = math.sqrt(E / density) -- m/s
local length, width, pulse = 1, 0.04, 0.5 -- m
local concrete = cdem.elastic{ youngs_modulus = E, poissons_ratio = 0, density = density }
local bond = cdem.mohr_coulomb{ cohesion = 20e6, friction_angle = 30, tensile_strength = T, softening = "linear",
                                fracture_energy_1 = G, fracture_energy_2 = 30 * G }
local mesh = cdem.box_mesh{ size = {length, width, width}, divisions = {cells, 1, 1} }
local model = cdem.model{ bodies = { { shape = mesh, material = concrete, joint = bond, name = "bar" } } }

-- A front over ten cells, then a straight fall over the length of the pulse.
local rise, fall = 10 * length / cells / c, pulse / c -- s
model:traction{ on = "x-", stress = {peak, 0, 0}, amplitude = { {0, 0}, {rise, 1}, {rise + fall, 0}, {1, 0} } }

-- The reflected front meets a pulse that has fallen by T at this distance from the free end.
local slab, arrival = pulse * T / (2 * peak), length / c + rise
local exact = { place = length - slab, time = arrival + slab / c, velocity = (2 * peak - T) / (density * c) }
local times, speeds, theory = {}, {}, {}
model:run{ duration = exact.time + slab / c, every = 5, callback = function()
  local since = model.time - length / c -- since the front came to the free end
  times[#times + 1], speeds[#times + 1] = model.time, model:at("velocity.x", {length, width / 2, width / 2})
  local part = since < 0 and 0 or since < rise and since / rise or 1 - (since - rise) / fall
  theory[#times] = 2 * peak * math.max(part, 0) / (density * c)
end }
model:picture{ file = "spall.png", colour = "velocity.x", deformation = 100, size = {1600, 0}, edges = false,
               title = "A slab flies off a bar" }
cdem.chart{ file = "end.png", title = "Velocity of the free end", x_label = "time (s)", y_label = "velocity (m/s)",
            series = { { name = "cdem", x = times, y = speeds },
                       { name = "bar that does not break", x = times, y = theory, style = "dashed" } } }

-- The slab is the piece at the free end; its face has broken when the last bond there has.
local pieces = model:fragments()
table.sort(pieces, function(a, b) return a.centroid[1] > b.centroid[1] end)
local place, when = length - pieces[1].mass / (density * width ^ 2), 0
for _, b in ipairs(model:breaks()) do
  if math.abs(b.place[1] - place) < 1.5 * length / cells then when = math.max(when, b.time) end
end
local function figure(name, value, reference, unit, tolerance)
  return { name = name, value = value, reference = reference, unit = unit, kind = "formula", source = "waves in a bar",
           tolerance = tolerance }
end
cdem.report{ figure("place_m", place, exact.place, "m", 0.02), figure("time_s", when, exact.time, "s", 0.05),
             figure("velocity_m_per_s", pieces[1].velocity[1], exact.velocity, "m/s", 0.1),
             { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
               source = "energy is conserved", tolerance_absolute = 2e-3 },
             { name = "pieces", value = #pieces }, { name = "wall_time_s", value = cdem.elapsed(), unit = "s" } }
