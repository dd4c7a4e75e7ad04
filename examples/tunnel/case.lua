-- A circular tunnel of radius 3 m at depth: in-situ stress, excavation in two stages (heading, bench) with bolts between
-- them, convergence, and the stress at the wall beside Kirsch's solution.
--
--   ./cdem run examples/tunnel/case.lua [--set sectors=24] [--set bolts=false] [--set k0=0.5]
local cdem = require "cdem"
local rings = require "rings"

local sectors = cdem.parameter{ name = "sectors", default = 32, range = {8, 128}, doc = "blocks around the tunnel" }
local bolts = cdem.parameter{ name = "bolts", default = true, doc = "set between heading and bench" }
local k0 = cdem.parameter{ name = "k0", default = 1.0, range = {0, 4}, doc = "horizontal over vertical stress" }

local a, outer, thickness = 3, 60, 0.5 -- m: radius, radius of the model, slice along the tunnel
local p = 5e6                          -- Pa, vertical pressure before the tunnel
local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
local blocks, far = rings.blocks(a, outer, sectors, thickness) -- far: outer radius of the first ring
local model = cdem.model{ bodies = { { name = "rock", shape = blocks, material = rock, element = "small_strain",
                                       joint = cdem.glued{ thickness_ratio = 0.01 } } } }
model:fix{ on = {"y-", "y+"}, axes = "y" }
model:fix{ on = function(x, _, z) return x * x + z * z > (0.97 * outer) ^ 2 end, axes = "xz" }
model:initial_stress{ stress = { -k0 * p, -rock.poissons_ratio * (1 + k0) * p, -p, 0, 0, 0 } }
model:relax{ residual = 1e-6 }
model:reset_displacement()

local function dig(name, part)
  local count = model:remove{ on = part }
  local result = model:relax{ residual = 1e-6 }
  cdem.log(string.format("%s: %d blocks dug out, %s; the roof sinks by %.2f mm", name, count,
                         result.converged and "in balance" or "not in balance",
                         1e3 * rings.towards(model, a, thickness, math.pi / 2)))
end
dig("heading", function(x, _, z) return x * x + z * z < a * a and z > 0 end)
if bolts then
  model:bolts{ pattern = { centre = {0, 0, 0}, radius = a + 0.05, length = 4, at = { thickness / 2 },
                           angles = { 20, 48, 76, 104, 132, 160 } },
               area = 4.9e-4, yield_stress = 500e6, grout_stiffness = 5e8, grout_strength = 2e5, plate = true }
end
dig("bench", function(x, _, z) return x * x + z * z < a * a end)

local wall = rings.beside_kirsch(model, { p = p, k0 = k0, a = a, outer = outer, far = far, sectors = sectors,
                                          thickness = thickness, rock = rock })
local figures = {
  { name = "hoop_stress_over_kirsch", value = wall.hoop, reference = 1, kind = "formula", source = "Kirsch 1898",
    tolerance = 0.03 },
  { name = "hoop_stress_worst_block", value = wall.worst },
  { name = "convergence_over_kirsch", value = wall.closure, reference = 1, kind = "formula",
    source = "Kirsch 1898, fixed at the outer radius", tolerance = 0.03 },
  { name = "energy_balance_error", value = model:energy().balance_error } }
if bolts then
  local largest = 0
  for _, node in ipairs(model:bolt_forces()) do largest = math.max(largest, node.tension) end
  figures[#figures + 1] = { name = "largest_bolt_tension", value = largest, unit = "N" }
  model:save_bolts{}
end
model:picture{ file = "tunnel.png", colour = "displacement.magnitude", edges = true, title = "Displacement, bolts",
               camera = { position = {0, -36, 0}, focal_point = {0, 0, 0}, up = {0, 0, 1}, view_angle = 24 } }
model:picture{ file = "hoop.png", colour = "principal_stress.3", title = "Largest pressure", bolts = false,
               camera = { position = {0, -40, 0}, focal_point = {0, 0, 0}, up = {0, 0, 1}, view_angle = 36 } }
cdem.report(figures)
