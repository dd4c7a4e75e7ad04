-- A heap of Voronoi blocks and a row of bricks are pushed off a ledge. They land on a floor and on two armour units;
-- none passes through, and energy is kept.
--
--   ./cdem run examples/collapse/case.lua [--set blocks=60]
local cdem = require "cdem"

local count = cdem.parameter{ name = "blocks", default = 30, range = {1, 5000}, doc = "of the heap" }
local element = cdem.parameter{ name = "element", default = "rigid", choices = {"finite_volume", "rigid"} }
local young = cdem.parameter{ name = "youngs_modulus", default = 2e8, range = {1e6, 1e11}, unit = "Pa" }
local friction = cdem.parameter{ name = "friction_angle", default = 30.0, range = {1, 80}, unit = "degrees" }
local fall = cdem.parameter{ name = "fall", default = 1.0, range = {0, 100}, unit = "s", doc = "without damping" }
local rest = cdem.parameter{ name = "rest", default = 0.25, range = {0, 100}, unit = "s",
                             doc = "with local damping, afterwards" }
local safety = cdem.parameter{ name = "safety", default = 0.5, range = {0.01, 1}, doc = "time step over the stable one" }
local every = cdem.parameter{ name = "every", default = 0.05, range = {1e-3, 10}, unit = "s", doc = "between pictures" }

local d, length, width, drop = 0.25, 0.8, 1.2, 0.8 -- m; d: cube root of a block's volume
local height = count * d ^ 3 / (length * width)
local stone = cdem.elastic{ youngs_modulus = young, poissons_ratio = 0.2, density = 2500 }
local rough = cdem.coulomb{ friction_angle = friction }
local solid = cdem.accropode{ height = 0.7, corner = 0 }

local function loose(name, shape)
  return { name = name, shape = shape, material = stone, joint = rough, element = element }
end
local function held(name, shape) return { name = name, shape = shape, material = stone, element = "rigid" } end
local function unit(x, y, angle)
  local turned = solid:rotate{ axis = {0, 0, 1}, angle = angle }
  return turned:translate{ shift = {x, y, -drop - turned:box().min[3]} }:mesh{ size = 0.25 }
end
local model = cdem.model{ bodies = {
  loose("heap", cdem.voronoi{ size = {length, width, height}, count = count, origin = {-length - 0.2, -width / 2, 0} }),
  loose("bricks", cdem.bricks{ size = {0.2, width, 0.4}, brick = {0.2, 0.4, 0.2}, origin = {-0.2, -width / 2, 0} }),
  held("ledge", cdem.box{ size = {1.6, width + 0.4, 0.3}, origin = {-1.6, -width / 2 - 0.2, -0.3} }),
  held("floor", cdem.box{ size = {4.6, 4, 0.2}, origin = {-1.6, -2, -drop - 0.2} }),
  held("pusher", cdem.box{ size = {0.2, width + 0.2, 0.8 * height}, origin = {-length - 0.4, -width / 2 - 0.1, 0.02} }),
  held("unit_1", unit(0.5, -0.4, 20)),
  held("unit_2", unit(0.8, 0.4, 75)),
}, contacts = { default = rough } }
model:fix{ on = {"ledge", "floor", "unit_1", "unit_2"} }
model:gravity{ vector = {0, 0, -9.81} }

local frames = {}
local function draw(name)
  model:picture{ file = name, colour = "velocity.magnitude", range = {0, 5}, deformation = 1,
                 title = string.format("%.2f s", model.time), plain = {"ledge", "floor", "pusher", "unit_1", "unit_2"},
                 broken_bonds = false, axes = false,
                 camera = { position = {5, -4.5, 2}, focal_point = {0.2, 0, -0.4}, up = {0, 0, 1}, view_angle = 30 } }
  return name
end
local step, undamped, energy = 0.025, 0, {}
for i = 1, math.floor((fall + rest) / step + 0.5) do
  local time = (i - 1) * step
  -- The pusher starts softly and stops at the edge of the ledge.
  model:fix{ on = "pusher", velocity = {time > 0.55 and 0 or 2 * math.min(1, time / 0.2), 0, 0} }
  model:run{ duration = step, safety = safety, local_damping = time < fall - 0.5 * step and 0 or 0.3 }
  energy = model:energy()
  if time < fall - 0.5 * step then undamped = math.max(undamped, energy.balance_error) end
  if (i * step + 0.1 * step) % every < 0.5 * step then
    frames[#frames + 1] = draw(string.format("frames/fall_%03d.png", #frames + 1))
  end
end
if #frames > 0 then cdem.film{ file = "fall.ogv", frames = frames, frames_per_second = 10 } end
draw("rest.png")
model:save{ file = "rest.vtu" }

-- What lies lower than it would if it had gone through the floor: blocks whose centroid is below the floor's top.
local through, moved = 0, 0
for _, block in ipairs(model:blocks()) do
  if block.body == "heap" or block.body == "bricks" then
    local z = block.centroid[3] + block.displacement[3]
    if z < -drop then through = through + 1 end
    if z < 0 then moved = moved + 1 end
  end
end
cdem.report{
  { name = "blocks_below_the_floor", value = through, reference = 0, kind = "formula", source = "none passes through",
    tolerance_absolute = 0.5 },
  { name = "blocks_off_the_ledge", value = moved },
  { name = "deepest_over_block_size", value = model:contacts().deepest / d, reference = 0, kind = "formula",
    source = "none passes through", tolerance_absolute = 0.05 },
  { name = "energy_balance_error", value = energy.balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 1e-3 },
  { name = "energy_balance_error_undamped", value = undamped },
  { name = "largest_velocity_m_per_s", value = model:max("velocity.magnitude", "heap"), unit = "m/s" },
  { name = "steps", value = model.steps },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
