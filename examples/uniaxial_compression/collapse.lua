-- What follows the failure of the plate in case.lua, --set until_stage=collapse: the same blocks, free to move far, on a
-- floor. The top is driven down by 10 mm, then stands still; the wedges slide out and fall.
local cdem = require "cdem"

local duration = cdem.parameter{ name = "collapse_duration", default = 0.3, range = {1e-4, 10}, unit = "s" }
-- Bodies fall and slide as fast with any density; stress waves are slower with a larger one, and steps longer.
local mass_scaling = cdem.parameter{ name = "mass_scaling", default = 400, range = {1, 1e4}, doc = "of the density" }
local film = cdem.parameter{ name = "film", default = true, doc = "of the collapse" }

local collapse = {}

function collapse.model(given)
  local box, m = given.plate:box(), given.rock
  local size, depth = box.max[1], box.max[3]
  local rock = cdem.elastic{ youngs_modulus = m.youngs_modulus, poissons_ratio = m.poissons_ratio,
                             density = mass_scaling * m.density }
  local floor = cdem.box{ size = {5 * size, 0.1 * size, 3 * depth}, origin = {-2 * size, -0.1 * size, -depth} }
  local model = cdem.model{ bodies = {
    { shape = given.plate, material = rock, joint = given.joint, name = "plate" },
    { shape = floor, material = rock, joint = given.joint, element = "rigid", name = "floor" },
  }, contacts = { default = cdem.coulomb{ friction_angle = 30 } } }
  local function plane(axis, x)
    local point, normal = {0, 0, 0}, {0, 0, 0}
    point[axis], normal[axis] = x, 1
    return cdem.select.plane{ point = point, normal = normal }
  end
  -- The bottom plane holds the floor too, whose top it is.
  return model, { back = plane(3, 0), front = plane(3, depth), bottom = plane(2, 0), top = plane(2, size) }
end

function collapse.run(model, on)
  local frames, every, stroke, speed = {}, duration / 60, 0.01, 0.5 -- m, m/s
  local camera = { position = {0.15, 0.13, 1.45}, focal_point = {0.15, 0.13, 0}, up = {0, 1, 0}, view_angle = 30 }
  -- Frames of the film have a camera; a picture fits the model.
  local function draw(name, of_film)
    model:picture{ file = name, colour = "displacement.magnitude", range = {0, 0.15}, deformation = 1, plain = {"floor"},
                   broken_bonds = false, axes = false, title = string.format("The failed plate comes apart, %.3f s", model.time),
                   camera = of_film and camera or nil, size = of_film and {1600, 1200} or {1600, 0} }
    return name
  end
  model:clear_loads()
  model:gravity{ vector = {0, -9.81, 0} }
  local start, open = model.time, 0
  for i = 1, 60 do
    model:fix{ on = on.top, axes = "xyz", velocity = {0, model.time - start < stroke / speed and -speed or 0, 0} }
    model:run{ duration = every, safety = 0.8 }
    open = math.max(open, model:energy().balance_error)
    if film then frames[i] = draw(string.format("frames/collapse_%03d.png", i), true) end
    if i == 20 then draw("sliding.png") end
  end
  if film then cdem.film{ file = "collapse.ogv", frames = frames, frames_per_second = 15 } end
  draw("collapsed.png")
  model:save{ file = "collapsed.vtu" }

  local fallen, outside, volume = 0, 0, 0
  for _, block in ipairs(model:blocks()) do
    if block.body == "plate" then
      volume = volume + block.volume
      if block.displacement[2] < -0.03 then fallen = fallen + block.volume end
      if block.centroid[2] + block.displacement[2] < 0 then outside = outside + 1 end
    end
  end
  cdem.report{
    { name = "fallen_part", value = fallen / volume, source = "of the volume: sunk by more than 30 mm" },
    { name = "blocks_below_the_floor", value = outside, reference = 0, kind = "formula", source = "none passes through",
      tolerance_absolute = 0.5 },
    { name = "overlap_over_volume", value = model:overlap().volume / volume,
      source = "of the joints under the top that is still pressed down" },
    { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
      source = "energy is conserved", tolerance_absolute = 0.01 },
    { name = "energy_balance_error_largest", value = open },
    { name = "steps", value = model.steps },
    { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
  }
end

return collapse
