-- The thinnest semicircular arch that stands under its own weight: dry voussoirs, no tension, friction that holds.
-- Thickness over mean radius is 0.1075 (Milankovitch 1907; Heyman 1969). A bisection finds it, then a thinner arch
-- falls to the ground.
--
--   ./cdem run examples/masonry_arch/case.lua [--set voussoirs=41] [--set halvings=8]
local cdem = require "cdem"
local arch = require "arch"

local halvings = cdem.parameter{ name = "halvings", default = 8, range = {0, 20}, doc = "of the interval 0.08 to 0.14" }
local collapse = cdem.parameter{ name = "collapse", default = true, doc = "a thinner arch falls, with a film" }
local safety = cdem.parameter{ name = "safety", default = 0.1, range = {0.01, 1},
                               doc = "of the fall: time step over the stable one" }

-- Stands: its kinetic energy is below 1e-9 of its weight times R at five looks in a row. Falls: it sinks by R/50.
local function stands(t)
  local model, looks, sinks = arch.model(t), 0, false
  local weight = math.pi * arch.R * t * arch.width * arch.density * arch.gravity
  model:run{ duration = 5, safety = 0.9, local_damping = 0.2, every = 500, stop = function()
    local slow = model.time > 0.1 and model:energy().kinetic < 1e-9 * weight * arch.R
    looks = slow and looks + 1 or 0
    sinks = model:min("displacement.z", "arch") < -arch.R / 50
    return looks == 5 or sinks
  end }
  cdem.log(string.format("t/R = %.5f %s after %.2f s", t / arch.R,
                         looks == 5 and "stands" or sinks and "falls" or "is undecided", model.time))
  return looks == 5
end

local function bisect(good, count)
  local falls, holds = 0.08 * arch.R, 0.14 * arch.R
  for _ = 1, count do
    local middle = 0.5 * (falls + holds)
    if good(middle) then holds = middle else falls = middle end
  end
  return 0.5 * (falls + holds) / arch.R, 0.5 * (holds - falls) / arch.R
end

local function beside(name, value)
  return { name = name, value = value, reference = 0.1075, kind = "paper", source = "Milankovitch 1907", tolerance = 0.05 }
end
local least, half_width = bisect(stands, halvings)
local figures = { beside("least_thickness_over_radius", least), { name = "found_to", value = half_width },
                  beside("line_of_thrust_at_these_joints", (bisect(arch.has_thrust_line, 40))) }
if collapse then
  local model, frames, open = arch.model(0.08 * arch.R), {}, 0
  for i = 1, 30 do
    model:run{ duration = 0.05, safety = safety }
    open = math.max(open, model:energy().balance_error)
    frames[i] = arch.draw(model, string.format("frames/fall_%03d.png", i))
    if i == 10 then arch.draw(model, "hinges.png") end
  end
  cdem.film{ file = "fall.ogv", frames = frames, frames_per_second = 10 }
  arch.draw(model, "fallen.png")
  figures[#figures + 1] = { name = "crown_sinks_over_radius", value = -model:min("displacement.z", "arch") / arch.R }
  figures[#figures + 1] = { name = "collapse_energy_balance_error", value = model:energy().balance_error, reference = 0,
                            kind = "formula", source = "energy is conserved", tolerance_absolute = 1e-3 }
  figures[#figures + 1] = { name = "collapse_energy_balance_error_largest", value = open }
  figures[#figures + 1] = { name = "collapse_deepest_over_thickness", value = model:contacts().deepest / (0.08 * arch.R) }
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
