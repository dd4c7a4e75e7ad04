-- The thinnest semicircular arch that stands under its own weight: dry voussoirs, no tension, friction that holds.
-- Thickness over mean radius is 0.1075 (Milankovitch 1907; Heyman 1969). A bisection finds it, then a thinner arch
-- falls to the ground.
--
--   ./cdem run examples/masonry_arch/case.lua [--set voussoirs=41] [--set halvings=8]
local cdem = require "cdem"

local n = cdem.parameter{ name = "voussoirs", default = 27, range = {5, 201}, doc = "odd: no joint at the crown" }
local halvings = cdem.parameter{ name = "halvings", default = 8, range = {0, 20}, doc = "of the interval 0.08 to 0.14" }
local young = cdem.parameter{ name = "youngs_modulus", default = 1e9, range = {1e6, 1e12}, unit = "Pa" }
local element = cdem.parameter{ name = "element", default = "finite_volume", choices = {"finite_volume", "rigid"} }
local draw = cdem.parameter{ name = "collapse", default = true, doc = "a thinner arch falls, with a film" }

local R, w, g, density = 1.0, 0.3, 9.81, 2500.0
local stone = cdem.elastic{ youngs_modulus = young, poissons_ratio = 0.2, density = density }
local dry = cdem.coulomb{ friction_angle = 60 }

local function arch(t)
  local shapes = {}
  for k = 1, n do
    local points = {}
    for _, a in ipairs{ math.pi * (k - 1) / n, math.pi * k / n } do
      for _, r in ipairs{ R - t / 2, R + t / 2 } do
        for _, y in ipairs{ 0, w } do points[#points + 1] = { r * math.cos(a), y, r * math.sin(a) } end
      end
    end
    shapes[k] = cdem.convex_hull{ points = points }
  end
  local ground = cdem.box{ size = {4.4, 2.4, 0.2}, origin = {-2.2, -1.05, -0.2} }
  local model = cdem.model{ bodies = {
    { shape = cdem.merge{ shapes = shapes }, material = stone, joint = dry, element = element, name = "arch" },
    { shape = ground, material = stone, element = "rigid", name = "ground" } }, contacts = { default = dry } }
  model:fix{ on = "ground" }
  model:gravity{ vector = {0, 0, -g}, amplitude = function(time) return math.min(1, time / 0.05) end }
  return model
end

-- Stands: its kinetic energy is below 1e-9 of its weight times R at five looks in a row. Falls: it sinks by R/50.
local function stands(t)
  local model, looks, sinks = arch(t), 0, false
  local weight = math.pi * R * t * w * density * g
  model:run{ duration = 5, safety = 0.9, local_damping = 0.2, every = 500, stop = function()
    local slow = model.time > 0.1 and model:energy().kinetic < 1e-9 * weight * R
    looks = slow and looks + 1 or 0
    sinks = model:min("displacement.z", "arch") < -R / 50
    return looks == 5 or sinks
  end }
  cdem.log(string.format("t/R = %.5f %s after %.2f s", t / R, looks == 5 and "stands" or sinks and "falls" or "is undecided",
                         model.time))
  return looks == 5
end

-- The same by statics: is there a thrust H at the crown, of moment K, whose line of thrust passes within every joint?
local function has_thrust_line(t)
  local inner, outer = R - t / 2, R + t / 2
  local function room(H) -- of K: its upper less its lower bound
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
    if room(p) < room(q) then a = p else b = q end
  end
  return room(a) >= 0
end

local function bisect(good, count)
  local falls, holds = 0.08 * R, 0.14 * R
  for _ = 1, count do
    local middle = 0.5 * (falls + holds)
    if good(middle) then holds = middle else falls = middle end
  end
  return 0.5 * (falls + holds) / R, 0.5 * (holds - falls) / R
end

local statics = bisect(has_thrust_line, 40)
cdem.log(string.format("line of thrust: %.5f", statics))
local least, half_width = bisect(stands, halvings)
local figures = {
  { name = "least_thickness_over_radius", value = least, reference = 0.1075, kind = "paper", source = "Milankovitch 1907",
    tolerance = 0.05 },
  { name = "found_to", value = half_width },
  { name = "line_of_thrust_at_these_joints", value = statics, reference = 0.1075, kind = "paper", source = "Milankovitch 1907",
    tolerance = 0.05 },
}
if draw then
  local model, frames = arch(0.08 * R), {}
  local function picture(name)
    model:picture{ file = name, colour = "velocity.magnitude", range = {0, 4}, deformation = 1, plain = {"ground"},
                   broken_bonds = false, axes = false, title = string.format("t/R = 0.08, %.2f s", model.time),
                   camera = { position = {1.2, -5.6, 2}, focal_point = {0, 0.1, 0.25}, up = {0, 0, 1}, view_angle = 30 } }
    return name
  end
  for i = 1, 30 do
    model:run{ duration = 0.05, safety = 0.5 }
    cdem.log(string.format("%.2f s: energy open by %.2g", model.time, model:energy().balance_error))
    frames[i] = picture(string.format("frames/fall_%03d.png", i))
  end
  cdem.film{ file = "fall.ogv", frames = frames, frames_per_second = 10 }
  picture("fallen.png")
  figures[#figures + 1] = { name = "crown_sinks_over_radius", value = -model:min("displacement.z", "arch") / R }
  figures[#figures + 1] = { name = "collapse_energy_balance_error", value = model:energy().balance_error, reference = 0,
                            kind = "formula", source = "energy is conserved", tolerance_absolute = 1e-3 }
  figures[#figures + 1] = { name = "collapse_deepest_over_thickness", value = model:contacts().deepest / (0.08 * R) }
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
