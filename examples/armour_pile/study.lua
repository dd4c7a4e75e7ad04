-- The flow that throws units out of one settled pile, at 5, 9 and 16 t, beside Feng 2014 Table 3 and the similarity law
-- V ~ mass^(1/6).
--
--   ./cdem run examples/armour_pile/settle.lua
--   ./cdem run examples/armour_pile/study.lua
local cdem = require "cdem"

local file = cdem.parameter{ name = "pile", default = "results/armour_pile-settle/pile.json", doc = "of settle.lua" }
local units = cdem.parameter{ name = "units", default = 4, range = {1, 100}, doc = "how many are to leave" }
local jobs = cdem.parameter{ name = "jobs", default = 2, range = {1, 64}, doc = "runs side by side" }

local masses, set = { 5000.0, 9000.0, 16000.0 }, {}
for i, mass in ipairs(masses) do set[i] = { mass = mass, pile = file, units = units } end
local runs = cdem.sweep{ script = "flow.lua", set = set, jobs = jobs }

local rows, figures = { mass_t = {} }, {}
for k = 1, units do rows["unit_" .. k] = {} end
for i, mass in ipairs(masses) do
  rows.mass_t[i] = mass / 1000
  for k = 1, units do
    local name = string.format("unit_%d_leaves_at_m_per_s_%g_t", k, mass / 1000)
    local velocity = runs[i].figures[name]
    rows["unit_" .. k][i] = velocity or 0
    figures[#figures + 1] = { name = name, value = velocity, unit = "m/s" }
  end
end
-- Mean over the units that left at both masses.
for i, mass in ipairs(masses) do
  if i > 1 then
    local sum, count = 0, 0
    for k = 1, units do
      if rows["unit_" .. k][1] > 0 and rows["unit_" .. k][i] > 0 then
        sum, count = sum + rows["unit_" .. k][i] / rows["unit_" .. k][1], count + 1
      end
    end
    figures[#figures + 1] = { name = string.format("similarity_ratio_%g_over_5", mass / 1000),
                              value = count > 0 and sum / count or nil, reference = (mass / masses[1]) ^ (1 / 6),
                              kind = "formula", source = "Froude: V ~ mass^(1/6)", tolerance = 0.05 }
  end
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
local columns = { { name = "mass_t", values = rows.mass_t } }
for k = 1, units do columns[#columns + 1] = { name = "unit_" .. k, values = rows["unit_" .. k] } end
cdem.write_csv{ file = "velocities.csv", columns = columns }
cdem.report(figures)
