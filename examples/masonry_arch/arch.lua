-- A semicircular arch of dry voussoirs on the ground, and its line of thrust, for the script beside this file.
local cdem = require "cdem"

local n = cdem.parameter{ name = "voussoirs", default = 27, range = {5, 201}, doc = "odd: no joint at the crown" }
local young = cdem.parameter{ name = "youngs_modulus", default = 1e9, range = {1e6, 1e12}, unit = "Pa" }
local element = cdem.parameter{ name = "element", default = "finite_volume", choices = {"finite_volume", "rigid"} }

local arch = { R = 1.0, width = 0.3, gravity = 9.81, density = 2500.0 } -- m, m/s2, kg/m3; R to the middle of the voussoirs
local R = arch.R

function arch.model(t)
  local stone = cdem.elastic{ youngs_modulus = young, poissons_ratio = 0.2, density = arch.density }
  local dry = cdem.coulomb{ friction_angle = 60 }
  local shapes = {}
  for k = 1, n do
    local points = {}
    for _, a in ipairs{ math.pi * (k - 1) / n, math.pi * k / n } do
      for _, r in ipairs{ R - t / 2, R + t / 2 } do
        for _, y in ipairs{ 0, arch.width } do points[#points + 1] = { r * math.cos(a), y, r * math.sin(a) } end
      end
    end
    shapes[k] = cdem.convex_hull{ points = points }
  end
  local ground = cdem.box{ size = {7, 4.3, 0.2}, origin = {-3.5, -2, -0.2} }
  local model = cdem.model{ bodies = {
    { shape = cdem.merge{ shapes = shapes }, material = stone, joint = dry, element = element, name = "arch" },
    { shape = ground, material = stone, element = "rigid", name = "ground" } }, contacts = { default = dry } }
  model:fix{ on = "ground" }
  model:gravity{ vector = {0, 0, -arch.gravity}, amplitude = function(time) return math.min(1, time / 0.05) end }
  return model
end

-- By statics: is there a thrust H at the crown, of moment K, whose line of thrust passes within every joint?
function arch.has_thrust_line(t)
  local inner, outer = R - t / 2, R + t / 2
  local function margin(H) -- of K: its upper less its lower bound
    local low, high = -math.huge, math.huge
    for k = 1, (n + 1) // 2 do
      local a = (k - 0.5 * (n % 2)) * math.pi / n
      local W, Wx = a * (outer ^ 2 - inner ^ 2) / 2, (outer ^ 3 - inner ^ 3) / 3 * (1 - math.cos(a))
      local along = H * math.cos(a) + W * math.sin(a)
      low, high = math.max(low, inner * along - Wx), math.min(high, outer * along - Wx)
    end
    return math.min(high, H * outer) - low
  end
  local a, b = 0, t * R
  for _ = 1, 100 do
    local p, q = a + (b - a) / 3, b - (b - a) / 3
    if margin(p) < margin(q) then a = p else b = q end
  end
  return margin(a) >= 0
end

function arch.draw(model, name)
  model:picture{ file = name, colour = "velocity.magnitude", range = {0, 4}, deformation = 1, plain = {"ground"},
                 broken_bonds = false, axes = false,
                 title = string.format("Arch with t/R = 0.08, %.2f s after its centring is gone", model.time),
                 camera = { position = {1.3, -7.4, 2.6}, focal_point = {0.1, 0.1, 0.35}, up = {0, 0, 1}, view_angle = 34 } }
  return name
end

return arch
