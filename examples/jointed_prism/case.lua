-- A prism with one joint, pressed until the joint slips: as two blocks of plastic rock, or as a mesh of rock that cracks. Its
-- strength stands beside Jaeger's formula (1960).
--
--   ./cdem run examples/jointed_prism/case.lua [--set dip=40] [--set model=blocks] [--set size=0.03]
local cdem = require "cdem"
local jaeger = require "jaeger"

local dip = cdem.parameter{ name = "dip", default = 60.0, range = {5, 75}, unit = "deg", doc = "of the joint" }
local kind = cdem.parameter{ name = "model", default = "mesh", choices = {"blocks", "mesh"} }
local size = cdem.parameter{ name = "size", default = 0.05, range = {0.01, 0.1}, unit = "m", doc = "of tetrahedra" }

local width, height, lateral, E, nu = jaeger.width, jaeger.height, jaeger.lateral, 30e9, 0.2
local rock, weak = cdem.mohr_coulomb(jaeger.rock), cdem.mohr_coulomb(jaeger.weak)
local halves = cdem.cut_by_plane{ shape = cdem.box{ size = {width, width, height} }, name = "joint",
                                  point = {width / 2, width / 2, height / 2},
                                  normal = {math.sin(math.rad(dip)), 0, math.cos(math.rad(dip))} }
local body = { name = "prism", material = cdem.elastic{ youngs_modulus = E, poissons_ratio = nu, density = 2600 } }
if kind == "blocks" then
  body.shape, body.joint, body.zone_size, body.plasticity = halves, weak, size, cdem.plastic(jaeger.rock)
else
  body.shape, body.joint, body.region_joints = halves:solid():mesh{ size = size }, rock, { {1, 2, weak} }
end
local rubbing = cdem.coulomb{ friction_angle = jaeger.weak.friction_angle }
local model = cdem.model{ bodies = {body}, contacts = { default = rubbing } }

-- Smooth platens, and a pressure on all sides.
model:fix{ on = "z-", axes = "z" }
model:fix{ on = cdem.select.box{ min = {0, 0, 0}, max = {0, 0, 0} }, axes = "xy" }
model:fix{ on = cdem.select.box{ min = {width, 0, 0}, max = {width, 0, 0} }, axes = "y" }
for _, side in ipairs{ "x-", "x+", "y-", "y+" } do model:traction{ on = side, pressure = lateral } end

-- Relaxed increments, parts of the elastic shortening at the strength, until the pressure has fallen.
local expected, shortening, pressure, peak = jaeger.strength(dip), {}, {}, 0
for i, part in ipairs{ 0.3, 0.6, 0.8, 0.9, 0.94, 0.96, 0.98, 1, 1.02, 1.04, 1.06, 1.08, 1.1, 1.12, 1.14, 1.16 } do
  shortening[i] = part * (expected - 2 * nu * lateral) / E * height
  model:fix{ on = "z+", axes = "z", displacement = {0, 0, -shortening[i]} }
  model:relax{ residual = 2e-4, max_steps = 10000 }
  pressure[i] = -model:reaction("z+")[3] / width ^ 2
  peak = math.max(peak, pressure[i])
  if pressure[i] < 0.97 * peak then break end
end

model:picture{ file = "slipped.png", colour = "displacement.x", deformation = 100, up = "z", size = {900, 0},
               title = "Slip along the joint" }
cdem.chart{ file = "pressure.png", x_label = "shortening (m)", y_label = "axial pressure (Pa)", series = {
  { name = "cdem", x = shortening, y = pressure, style = "both" },
  { name = "Jaeger", x = {0, shortening[#shortening]}, y = {expected, expected}, style = "dashed" } } }
cdem.report{ { name = "strength_Pa", value = peak, reference = expected, unit = "Pa", kind = "formula", source = "Jaeger 1960",
               tolerance = 0.05 } }
