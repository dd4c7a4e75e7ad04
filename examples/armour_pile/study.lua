-- The flow that throws units out of one settled pile, at 5, 9 and 16 t, held and as a ramp, beside Feng 2014 Table 3 and
-- the similarity law V ~ mass^(1/6).
--
--   ./cdem run examples/armour_pile/settle.lua
--   ./cdem run examples/armour_pile/study.lua [--set modes=hold] [--set first_velocity=5]
local cdem = require "cdem"

local file = cdem.parameter{ name = "pile", default = "results/armour_pile-settle/pile.json", doc = "of settle.lua" }
local modes = cdem.parameter{ name = "modes", default = "both", choices = {"both", "hold", "ramp"} }
local units = cdem.parameter{ name = "units", default = 4, range = {1, 100}, doc = "how many are to leave" }
local first = cdem.parameter{ name = "first_velocity", default = 3.0, range = {0.1, 100}, unit = "m/s", doc = "for 5 t" }
local step = cdem.parameter{ name = "velocity_step", default = 0.25, range = {1e-3, 10}, unit = "m/s", doc = "for 5 t" }
local rate = cdem.parameter{ name = "ramp_rate", default = 1.0, range = {1e-3, 100}, unit = "m/s2", doc = "of ramp" }
local walls = cdem.parameter{ name = "walls", default = false, doc = "those of settle.lua stay" }
local jobs = cdem.parameter{ name = "jobs", default = 2, range = {1, 64}, doc = "runs side by side" }

local masses = { 5000.0, 9000.0, 16000.0 }
local set, run_of = {}, {} -- run_of["ramp 9000"]: number of that run
for _, mode in ipairs(modes == "both" and {"hold", "ramp"} or {modes}) do
  for _, mass in ipairs(masses) do
    set[#set + 1] = { mass = mass, pile = file, units = units, mode = mode, first_velocity = first, velocity_step = step,
                      ramp_rate = rate, walls = walls }
    run_of[mode .. " " .. mass] = #set
  end
end
local runs = cdem.sweep{ script = "flow.lua", set = set, jobs = jobs }

local columns, figures = { { name = "mass_t", values = {} } }, {}
for i, mass in ipairs(masses) do columns[1].values[i] = mass / 1000 end
for _, mode in ipairs{ "hold", "ramp" } do
  local ending = mode == "ramp" and "_ramp" or ""
  local left = {} -- left[i][k]: velocity at which unit k left, of mass i
  for i, mass in ipairs(masses) do
    local run = runs[run_of[mode .. " " .. mass]]
    left[i] = {}
    for k = 1, run and units or 0 do
      local name = string.format("unit_%d_leaves_at_m_per_s_%g_t%s", k, mass / 1000, ending)
      left[i][k] = run.figures[name]
      figures[#figures + 1] = { name = name, value = left[i][k], unit = "m/s" }
    end
    -- Mean over the units that left at both masses.
    local sum, count = 0, 0
    for k = 1, units do
      if left[1][k] and left[i][k] then sum, count = sum + left[i][k] / left[1][k], count + 1 end
    end
    if run and i > 1 then
      figures[#figures + 1] = { name = string.format("similarity_ratio_%g_over_5%s", mass / 1000, ending),
                                value = count > 0 and sum / count or nil, reference = (mass / masses[1]) ^ (1 / 6),
                                kind = "formula", source = "Froude: V ~ mass^(1/6)", tolerance = 0.05 }
    end
  end
  for k = 1, run_of[mode .. " " .. masses[1]] and units or 0 do
    local column = { name = "unit_" .. k .. "_" .. mode, values = {} }
    for i in ipairs(masses) do column.values[i] = left[i][k] or 0 end
    columns[#columns + 1] = column
  end
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.write_csv{ file = "velocities.csv", columns = columns }
cdem.report(figures)
