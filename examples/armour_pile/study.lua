-- The flow that throws units out of a settled pile, at 5, 9 and 16 t, held and as a ramp, beside Feng 2014 Table 3 and
-- the similarity law V ~ mass^(1/6). Which unit sticks and which slips changes with the last digits, so that one pile
-- tells little: with several, means and their standard errors over piles.
--
--   ./cdem run examples/armour_pile/study.lua [--set modes=hold] [--set first_velocity=5]   # settles one pile, then its flows
--   ./cdem run examples/armour_pile/study.lua --set piles=6 [--set first_seed=1]            # seeds 1 to 6
--   ./cdem run examples/armour_pile/study.lua --set pile=results/armour_pile-settle/pile.json
local cdem = require "cdem"

local file = cdem.parameter{ name = "pile", default = "", doc = "that settle.lua wrote; none: piles are settled first" }
local piles = cdem.parameter{ name = "piles", default = 1, range = {1, 100}, doc = "to settle" }
local first_seed = cdem.parameter{ name = "first_seed", default = 1, range = {0, 1e6}, doc = "of the piles; they count up" }
local sliding = cdem.parameter{ name = "sliding_angle", default = 15.0, range = {0, 80}, unit = "deg",
                                doc = "of settle.lua" }
local modes = cdem.parameter{ name = "modes", default = "both", choices = {"both", "hold", "ramp"} }
local units = cdem.parameter{ name = "units", default = 4, range = {1, 100}, doc = "how many are to leave" }
local first = cdem.parameter{ name = "first_velocity", default = 3.0, range = {0.1, 100}, unit = "m/s", doc = "for 5 t" }
local step = cdem.parameter{ name = "velocity_step", default = 0.25, range = {1e-3, 10}, unit = "m/s", doc = "for 5 t" }
local rate = cdem.parameter{ name = "ramp_rate", default = 1.0, range = {1e-3, 100}, unit = "m/s2", doc = "of ramp" }
local walls = cdem.parameter{ name = "walls", default = false, doc = "those of settle.lua stay" }
local draw = cdem.parameter{ name = "pictures", default = false, doc = "of each run" }
local jobs = cdem.parameter{ name = "jobs", default = 2, range = {1, 64}, doc = "runs side by side" }

local masses = { 5000.0, 9000.0, 16000.0 }
local files = { file }
if file ~= "" then
  piles = 1
else
  local settings = {}
  for pile = 1, piles do settings[pile] = { seed = first_seed + pile - 1, sliding_angle = sliding, pictures = false } end
  for pile, run in ipairs(cdem.sweep{ script = "settle.lua", set = settings, jobs = jobs }) do
    files[pile] = "../" .. run.output .. "/pile.json"
  end
end
local set, run_of = {}, {} -- run_of["ramp 9000 1"]: number of that run of pile 1
for pile = 1, piles do
  for _, mode in ipairs(modes == "both" and {"hold", "ramp"} or {modes}) do
    for _, mass in ipairs(masses) do
      set[#set + 1] = { pile = files[pile], mass = mass, mode = mode, units = units,
                        first_velocity = first, velocity_step = step, ramp_rate = rate, walls = walls, pictures = draw }
      run_of[string.format("%s %g %d", mode, mass, pile)] = #set
    end
  end
end
local runs = cdem.sweep{ script = "flow.lua", set = set, jobs = jobs }

-- Velocities at which units left, of one run; as many as did.
local function velocities(mode, mass, pile)
  local run, list = runs[run_of[string.format("%s %g %d", mode, mass, pile)] or 0], {}
  for k = 1, run and units or 0 do
    list[k] = run.figures[string.format("unit_%d_leaves_at_m_per_s_%g_t%s", k, mass / 1000, mode == "ramp" and "_ramp" or "")]
  end
  return list
end

-- Mean of a list and its standard error, none of less than two values.
local function mean(list)
  local sum, square = 0, 0
  for _, x in ipairs(list) do sum = sum + x end
  if #list == 0 then return nil, nil end
  for _, x in ipairs(list) do square = square + (x - sum / #list) ^ 2 end
  return sum / #list, #list > 1 and (square / (#list - 1) / #list) ^ 0.5 or nil
end

local columns, figures = { { name = "pile", values = {} }, { name = "mass_t", values = {} } }, {}
for pile = 1, piles do
  for _, mass in ipairs(masses) do
    table.insert(columns[1].values, pile)
    table.insert(columns[2].values, mass / 1000)
  end
end
for _, mode in ipairs(modes == "both" and {"hold", "ramp"} or {modes}) do
  local ending = mode == "ramp" and "_ramp" or ""
  for k = 1, units do
    local column = { name = "unit_" .. k .. "_" .. mode, values = {} }
    for pile = 1, piles do
      for _, mass in ipairs(masses) do column.values[#column.values + 1] = velocities(mode, mass, pile)[k] or 0 end
    end
    columns[#columns + 1] = column
  end
  for _, mass in ipairs(masses) do
    for k = 1, units do
      local list = {}
      for pile = 1, piles do list[#list + 1] = velocities(mode, mass, pile)[k] end
      local value, standard_error = mean(list)
      local name = string.format("unit_%d_leaves_at_m_per_s_%g_t%s", k, mass / 1000, ending)
      figures[#figures + 1] = { name = name, value = value, unit = "m/s" }
      if piles > 1 then figures[#figures + 1] = { name = name .. "_standard_error", value = standard_error, unit = "m/s" } end
    end
    -- For each pile: mean over the units that left at both masses.
    local ratios = {}
    for pile = 1, piles do
      local least, here, both = velocities(mode, masses[1], pile), velocities(mode, mass, pile), {}
      for k = 1, units do
        if least[k] and here[k] then both[#both + 1] = here[k] / least[k] end
      end
      ratios[#ratios + 1] = mean(both)
    end
    if mass > masses[1] then
      local value, standard_error = mean(ratios)
      local name = string.format("similarity_ratio_%g_over_5%s", mass / 1000, ending)
      figures[#figures + 1] = { name = name, value = value, reference = (mass / masses[1]) ^ (1 / 6), kind = "formula",
                                source = "Froude: V ~ mass^(1/6)", tolerance = 0.05 }
      if piles > 1 then figures[#figures + 1] = { name = name .. "_standard_error", value = standard_error } end
    end
  end
end
for _, name in ipairs{ "max_penetration_over_height", "energy_balance_error" } do
  local worst = 0
  for _, run in ipairs(runs) do worst = math.max(worst, run.figures[name] or 0) end
  figures[#figures + 1] = { name = name, value = worst, source = "the worst of all runs" }
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.write_csv{ file = "velocities.csv", columns = columns }
cdem.report(figures)
