-- A block on an incline: below the friction angle it stays, above it slides with g (sin a - tan(phi) cos a).
--
--   ./cdem run examples/sliding_block/case.lua [--set size=0.01] [--set friction_angle=25]
local cdem = require "cdem"

local size = cdem.parameter{ name = "size", default = 1.0, range = {1e-3, 100}, unit = "m", doc = "of the block" }
local phi = cdem.parameter{ name = "friction_angle", default = 30.0, range = {1, 60}, unit = "degrees" }

local stone = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local plate = cdem.solid.box{ size = {4 * size, 2 * size, 0.2 * size}, origin = {-size, -size, -0.2 * size} }
local block = cdem.solid.box{ size = {size, size, 0.4 * size}, origin = {-size / 2, -size / 2, 0} }
local g = 9.81

-- The plate is level, and gravity is inclined by the angle instead. Returns the displacement of the block after `time`,
-- m.
local function slide(angle, time, picture)
  local model = cdem.model{
    bodies = { { shape = plate:mesh{ size = 0.5 * size }, material = stone, element = "rigid", name = "plate" },
               { shape = block:mesh{ size = 0.3 * size }, material = stone, element = "rigid", name = "block" } },
    -- Without energy loss the block begins to rock on its leading edge while it slides, which changes its displacement
    -- by a per cent.
    contacts = { { "plate", "block", cdem.coulomb{ friction_angle = phi, restitution = 0.5 } } },
  }
  model:fix{ on = "plate" }
  model:gravity{ vector = {0, 0, -g} }
  model:run{ duration = 0.1 * math.sqrt(size / g), local_damping = 0.5 } -- it comes to stand
  local a = math.rad(angle)
  model:gravity{ vector = {g * math.sin(a), 0, -g * math.cos(a)} }
  local start = model:mean("displacement.x", "block")
  model:run{ duration = time }
  if picture then
    model:picture{ file = picture, view = "iso", up = "z", colour = "displacement.x", deformation = 1,
                   size = {1600, 0}, plain = {"plate"}, range = {0, size},
                   title = string.format("Slid for %.2f s, gravity inclined by %g degrees", time, angle) }
  end
  return model:mean("displacement.x", "block") - start, model
end

local figures = {}
for _, more in ipairs{ -5, 2, 5, 10, 20 } do
  local angle = phi + more
  local a = math.rad(angle)
  local expected = math.max(0, g * (math.sin(a) - math.tan(math.rad(phi)) * math.cos(a)))
  local time = math.sqrt(2 * size / (expected > 0 and expected or g * math.sin(a)))
  local way, model = slide(angle, time, more == 20 and "slid.png" or nil)
  local acceleration = 2 * way / time ^ 2
  cdem.log(string.format("%g degrees: %.4g m/s2, formula %.4g", angle, acceleration, expected))
  figures[#figures + 1] = { name = string.format("acceleration_at_%g_degrees_m_per_s2", angle), value = acceleration,
                            unit = "m/s2", reference = expected, kind = "formula", source = "g (sin a - tan(phi) cos a)",
                            tolerance = expected > 0 and 0.005 or nil, tolerance_absolute = expected == 0 and 1e-3 or nil }
  if more == 20 then
    figures[#figures + 1] = { name = "energy_balance_error", value = model:energy().balance_error, reference = 0,
                              kind = "formula", source = "energy is conserved", tolerance_absolute = 0.01 }
  end
end
cdem.report(figures)
