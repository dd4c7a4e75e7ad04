-- Feng 2014, section 4: a flow up the slope throws the units of a settled pile out one by one. Its velocity rises in
-- steps and is held while anything moves (hold), or rises all the time (ramp).
--
--   ./cdem run examples/armour_pile/settle.lua
--   ./cdem run examples/armour_pile/flow.lua [--set mass=9000] [--set mode=ramp] [--set pile=FOLDER/pile.json]
--
-- A smaller pile has its own folder, and fewer units that may be held:
--
--   ./cdem run examples/armour_pile/flow.lua --set held=2 \
--       --set pile="results/armour_pile-settle-columns=3,count=12,held=3/pile.json"
local cdem = require "cdem"
local set_up = require "pile"

local mass = cdem.parameter{ name = "mass", default = 5000.0, range = {1, 1e6}, unit = "kg", doc = "the pile is scaled" }
local file = cdem.parameter{ name = "pile", default = "results/armour_pile-settle/pile.json",
                             doc = "that settle.lua wrote: run it first" }
local mode = cdem.parameter{ name = "mode", default = "hold", choices = {"hold", "ramp"} }
local first = cdem.parameter{ name = "first_velocity", default = 3.0, range = {0.1, 100}, unit = "m/s", doc = "for 5 t" }
local step = cdem.parameter{ name = "velocity_step", default = 0.25, range = {1e-3, 10}, unit = "m/s", doc = "for 5 t" }
local rate = cdem.parameter{ name = "ramp_rate", default = 1.0, range = {1e-3, 100}, unit = "m/s2", doc = "of ramp" }
local most = cdem.parameter{ name = "max_velocity", default = 15.0, range = {1, 100}, unit = "m/s", doc = "for 5 t" }
local wanted = cdem.parameter{ name = "units", default = 4, range = {1, 100}, doc = "ends when so many have left" }
local hold = cdem.parameter{ name = "hold", default = 0.2, range = {1e-3, 10}, unit = "s", doc = "at least, for 5 t" }
local longest = cdem.parameter{ name = "longest_hold", default = 1.5, range = {1e-3, 100}, unit = "s", doc = "for 5 t" }
local damping = cdem.parameter{ name = "stiffness_damping", default = 1e-5, range = {0, 1e-3}, unit = "s",
                                doc = "for 5 t: 1 % of critical damping at a unit's lowest frequency" }
local held = cdem.parameter{ name = "held", default = 5, range = {0, 100}, doc = "highest and lowest units that are held" }
local friction = cdem.parameter{ name = "friction_angle", default = 35.0, range = {0, 80}, unit = "deg" }
local walls = cdem.parameter{ name = "walls", default = false, doc = "those of settle.lua stay" }
local draw = cdem.parameter{ name = "pictures", default = true, doc = "draw them" }

local pile = cdem.read_pile{ file = file }
local free = #pile:poses() - 2 * held
if free < wanted then
  error(string.format("units = %d: only %d of the pile's %d are free; hold fewer (--set held=...) or ask for fewer to leave",
                      wanted, math.max(0, free), #pile:poses()), 0)
end
pile = pile:scaled{ factor = (mass / set_up.density / pile.unit_volume) ^ (1 / 3) }
local height = pile.height
-- Froude's law: lengths go with H, times and velocities with its root. 5 t stand for themselves.
local scale = (mass / 5000) ^ (1 / 6)
local length = pile:box().max[1] + 2 * height
local model, ground = set_up.model(pile, { length = length, friction_angle = friction, walls = walls,
                                           stiffness_damping = damping * (mass / 5000) ^ (1 / 3) })
if held > 0 then
  for _, numbers in ipairs{ model:lowest_units{ body = "units", count = held },
                            model:highest_units{ body = "units", count = held } } do
    model:fix{ on = cdem.select.units{ body = "units", numbers = numbers } }
  end
end
-- The pile carries itself again, without its walls if they are gone; what damping of motion there is ends here.
model:settle{ max_time = 20 * scale }

local function places() return model:pile{ body = "units" }:poses() end
local left
-- A number on each unit that has left.
local function marks()
  local list = {}
  for k = 1, left and #left or 0 do
    list[k] = { at = places()[left[k].unit].centroid, label = tostring(k), size = 40, colour = {0.85, 0.1, 0.1} }
  end
  return list
end
local function picture(name, title)
  if draw then
    set_up.picture(model, ground, { file = name, title = title, colour = "displacement.magnitude", range = {0, height},
                                    markers = marks() })
  end
end

left = model:watch{ body = "units", leaves = 0.5 * height }
local memory = model.memory
memory.velocity, memory.since, memory.gone, memory.whole = first * scale, model.time, 0, math.floor(first)
if mode == "ramp" then
  local start = model.time
  model:flow{ on = "units", direction = {1.5, 0, 1}, water_density = set_up.water, relative = false, -- as the paper
              velocity = function(time) return first * scale + rate * math.max(0, time - start) end }
else
  model:flow{ on = "units", direction = {1.5, 0, 1}, water_density = set_up.water, relative = false, -- as the paper
              velocity = function() return memory.velocity end }
end

-- hold: the flow rises when no unit has gone further than a hundredth of its height since it last rose or was looked at,
-- or at the latest after the longest hold: a unit that rocks between its neighbours may do so for long.
memory.places, memory.looked = places(), model.time
local function furthest_way()
  local now = places()
  local most_moved = math.max(table.unpack(set_up.ways(memory.places, now)))
  memory.places, memory.looked = now, model.time
  return most_moved
end
-- A picture of what has moved whenever the flow passes another whole m/s (of 5 t).
local function rise_to(velocity)
  local whole = math.floor(velocity / scale + 1e-9)
  if whole > memory.whole then
    memory.whole = whole
    picture(string.format("up_to_%02d.png", whole), string.format("up to %.2f m/s", memory.velocity))
  end
  memory.velocity = velocity
end
local function raise()
  if #left > memory.gone then
    memory.gone = #left
    picture(string.format("left_%d.png", #left),
            string.format("No. %d to leave: unit %d, at %.2f m/s", #left, left[#left].unit, left[#left].velocity))
  end
  if mode == "ramp" then
    rise_to(first * scale + rate * (model.time - memory.since))
    return
  end
  if model.time - memory.looked < hold * scale then return end
  local way = furthest_way()
  if way < 0.01 * height or model.time - memory.since >= longest * scale then
    rise_to(memory.velocity + step * scale)
    memory.since = model.time
    cdem.log(string.format("%.2f s: the flow rises to %.2f m/s (furthest way in the last %.2g s: %.2g H)", model.time,
                           memory.velocity, hold * scale, way / height))
  end
end
model:run{ duration = 60 * scale, every = 200, callback = raise, stop = function()
  return #left >= wanted or memory.velocity > most * scale
end }
picture("end.png", string.format("at %.2f m/s", memory.velocity))
if #left < wanted then
  cdem.log(string.format("%d of %d units left up to %.2f m/s", #left, wanted, memory.velocity))
end
model:save{ file = "end.vtu" }

local paper = {}
local table_3 = cdem.read_csv("feng2014-table3.csv")
for i, t in ipairs(table_3.mass_t) do
  if math.abs(t * 1000 - mass) < 1 then
    for k = 1, 4 do
      local velocity = table_3["unit_" .. k][i]
      if velocity > 0 then paper[k] = velocity end
    end
  end
end
local figures = {}
for k = 1, wanted do
  local name = string.format("unit_%d_leaves_at_m_per_s_%g_t", k, mass / 1000)
  figures[k] = { name = mode == "ramp" and name .. "_ramp" or name, unit = "m/s",
                 value = left[k] and left[k].velocity, reference = paper[k], kind = "paper",
                 source = "Feng 2014 table 3, another pile" }
  if left[k] then
    cdem.log(string.format("unit %d left at %.2f m/s, %.2f s", left[k].unit, left[k].velocity, left[k].time))
  end
end
local contacts = model:contacts()
for _, figure in ipairs{ { name = "max_penetration_over_tet_height", value = contacts.deepest_over_tet_height },
                         { name = "max_penetration_over_height", value = contacts.deepest / height, reference = 0,
                           kind = "formula", source = "nothing passes through", tolerance_absolute = 0.01 },
                         { name = "energy_balance_error", value = model:energy().balance_error },
                         { name = "steps", value = model.steps },
                         { name = "wall_time_s", value = cdem.elapsed(), unit = "s" } } do
  figures[#figures + 1] = figure
end
cdem.report(figures)
