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
local length, width, pulse, c = 1, 0.04, 0.5, math.sqrt(E / density) -- m, m, m, m/s
local concrete = cdem.elastic{ youngs_modulus = E, poissons_ratio = 0, density = density }
local bond = cdem.mohr_coulomb{ cohesion = 20e6, friction_angle = 30, tensile_strength = T, softening = "linear",
                                fracture_energy_1 = G, fracture_energy_2 = 30 * G }
local mesh = cdem.box_mesh{ size = {length, width, width}, divisions = {cells, 1, 1} }
local model = cdem.model{ bodies = { { shape = mesh, material = concrete, joint = bond, name = "bar" } } }

-- A front over ten cells, then a straight fall over the length of the pulse.
local rise, fall = 10 * length / cells / c, pulse / c -- s
model:traction{ on = "x-", stress = {peak, 0, 0}, amplitude = { {0, 0}, {rise, 1}, {rise + fall, 0}, {1, 0} } }

-- The reflected front meets a pulse that has fallen by T at the distance `slab` from the free end.
local arrival, slab, free = length / c, pulse * T / (2 * peak), 2 * peak / (density * c) -- s, m, m/s
local place, time, velocity = length - slab, arrival + rise + slab / c, free - T / (density * c)
model:probe{ name = "free_end", field = "velocity.x", at = {length, width / 2, width / 2} }
model:run{ duration = time + slab / c, every = 2 }

model:picture{ file = "spall.png", colour = "velocity.x", deformation = 100, size = {1600, 0}, edges = false,
               title = "A slab flies off a bar" }
local history = model:history()
cdem.chart{ file = "end.png", title = "Velocity of the free end", x_label = "time (s)", y_label = "velocity (m/s)",
            x_range = {0, time + slab / c}, series = { { name = "cdem", x = history.time, y = history.free_end },
            { name = "bar that does not break", x = {0, arrival, arrival + rise, arrival + rise + fall}, y = {0, 0, free, 0},
              style = "dashed" } } }

-- The slab is the piece at the free end; its face has broken when the last bond there has.
local pieces, broken = model:fragments(), 0
table.sort(pieces, function(a, b) return a.centroid[1] > b.centroid[1] end)
local face = length - pieces[1].mass / (density * width ^ 2)
for _, b in ipairs(model:breaks()) do
  if math.abs(b.place[1] - face) < 1.5 * length / cells then broken = math.max(broken, b.time) end
end
local function figure(name, value, reference, tolerance)
  return { name = name, value = value, reference = reference, kind = "formula", source = "waves in a bar",
           tolerance = tolerance }
end
cdem.report{ figure("place_m", face, place, 0.02), figure("time_s", broken, time, 0.05),
             figure("velocity_m_per_s", pieces[1].velocity[1], velocity, 0.1),
             { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
               source = "energy is conserved", tolerance_absolute = 2e-3 },
             { name = "pieces", value = #pieces }, { name = "wall_time_s", value = cdem.elapsed(), unit = "s" } }
