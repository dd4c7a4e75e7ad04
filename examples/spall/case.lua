-- A bar whose end is struck: the pressure pulse runs to the free end, comes back as tension and breaks slabs off.
-- Place, time and velocity of both slabs stand beside the theory of waves in a bar.
--
--   ./cdem run examples/spall/case.lua [--set cells=200]
local cdem = require "cdem"

local cells = cdem.parameter{ name = "cells", default = 100, range = {40, 400}, doc = "along the bar" }

-- Concrete without lateral strain: a bar of any section carries plane waves.
local E, density, T = 30e9, 2400, 4e6
local c = math.sqrt(E / density) -- m/s
local length, width, pulse, peak = 1, 0.04, 0.5, 10e6 -- m, m, m, Pa
local concrete = cdem.elastic{ youngs_modulus = E, poissons_ratio = 0, density = density }
local bond = cdem.mohr_coulomb{ cohesion = 20e6, friction_angle = 30, tensile_strength = T }
local mesh = cdem.box_mesh{ size = {length, width, width}, divisions = {cells, 3, 3} }
local model = cdem.model{ bodies = { { shape = mesh, material = concrete, joint = bond, name = "bar" } } }

-- A front that the mesh can carry, then a straight fall over the length of the pulse.
local rise, fall = 10 * length / cells / c, pulse / c -- s
model:traction{ on = "x-", stress = {peak, 0, 0}, amplitude = { {0, 0}, {rise, 1}, {rise + fall, 0}, {1, 0} } }

-- The reflected front meets a pulse that has fallen by T at pulse T / (2 peak) from the free end, and as far again behind it.
local thick, arrival = pulse * T / (2 * peak), length / c + rise
local exact = { velocity = { (2 * peak - T) / (density * c), (2 * peak - 3 * T) / (density * c) },
                time = { arrival + thick / c, arrival + 3 * thick / c } }
model:run{ duration = exact.time[2] + 0.5 * thick / c }
model:picture{ file = "spall.png", colour = "velocity.x", deformation = 200, size = {1600, 0}, edges = false,
               title = "Two slabs fly off a struck bar" }

-- The slabs and the rest of the bar, from the free end on; their faces broke when the last of the bonds between them did.
local pieces = {}
for _, piece in ipairs(model:fragments()) do
  if piece.mass > 1e-3 * density * length * width ^ 2 then pieces[#pieces + 1] = piece end
end
table.sort(pieces, function(a, b) return a.centroid[1] > b.centroid[1] end)
local figures, place = {}, length
for i = 1, 2 do
  local piece, when = pieces[i], 0
  place = place - (piece and piece.mass / (density * width ^ 2) or 0)
  for _, b in ipairs(model:breaks()) do
    if math.abs(b.place[1] - place) < 1.5 * length / cells then when = math.max(when, b.time) end
  end
  local function add(name, value, reference, unit, tolerance)
    figures[#figures + 1] = { name = name .. "_" .. i, value = value, reference = reference, unit = unit, kind = "formula",
                              source = "waves in a bar", tolerance = tolerance }
  end
  add("place_m", place, length - i * thick, "m", 0.01)
  add("time_s", when, exact.time[i], "s", 0.03)
  add("velocity_m_per_s", piece and piece.velocity[1] or 0, exact.velocity[i], "m/s", 0.03)
end
figures[#figures + 1] = { name = "slabs", value = #pieces - 1, reference = 2, kind = "formula", source = "waves in a bar" }
figures[#figures + 1] = { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
                          source = "energy is conserved", tolerance_absolute = 2e-3 }
cdem.report(figures)
