-- The height from which each unit breaks, by shape and attitude: case.lua many times, one table and one chart.
--
--   ./cdem run examples/drop_test/study.lua [--set fineness=6] [--set mass=5000]
--   ./cdem run examples/drop_test/study.lua --set test=overturning
local cdem = require "cdem"

local test = cdem.parameter{ name = "test", default = "drop", choices = {"drop", "overturning", "pendulum"} }
local mass = cdem.parameter{ name = "mass", default = 16000.0, range = {1, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 3.0, range = {2, 30}, doc = "Dn over edge of the tets" }
local bisections = cdem.parameter{ name = "bisections", default = 2, range = {0, 20} }
local only = cdem.parameter{ name = "attitude", default = test == "drop" and "all" or "flat",
                             choices = {"all", "flat", "edge", "corner"} }
local target = cdem.parameter{ name = "target", default = "block", choices = {"block", "unit"}, doc = "of a pendulum" }

local shapes, attitudes = {"cube", "cubipod", "dolos", "tetrapod", "accropode"}, {"flat", "edge", "corner"}
if only ~= "all" then attitudes = {only} end
local sets = {}
for _, shape in ipairs(shapes) do
  for _, attitude in ipairs(attitudes) do
    sets[#sets + 1] = { test = test, target = target, shape = shape, attitude = attitude, mass = mass, fineness = fineness,
                        bisections = bisections, pictures = false }
  end
end
local results = cdem.sweep{ script = "case.lua", set = sets }
local series, figures, found = {}, {}, {}
for a, attitude in ipairs(attitudes) do
  series[a] = { name = test == "drop" and attitude or test, x = {}, y = {}, style = "points" }
end
for i, result in ipairs(results) do
  local s, a = (i - 1) // #attitudes + 1, (i - 1) % #attitudes + 1
  local name, height = shapes[s] .. "_" .. attitudes[a], result.figures and result.figures.critical_height_m
  found[name] = height
  series[a].x[s], series[a].y[s] = s + 0.12 * (a - (#attitudes + 1) / 2), height or 0 / 0
  figures[#figures + 1] = { name = name .. "_m", value = height, unit = "m" }
  if test == "overturning" and result.figures then
    figures[#figures + 1] = { name = name .. "_tilt_deg", value = result.figures.critical_tilt_deg, unit = "deg" }
    figures[#figures + 1] = { name = name .. "_balance_m", value = result.figures.height_from_balance_m, unit = "m" }
  end
end
local columns = { { name = "shape", values = {1, 2, 3, 4, 5} } }
for a, attitude in ipairs(attitudes) do columns[a + 1] = { name = attitude .. "_m", values = series[a].y } end
if test == "drop" then -- full-scale tests, Scaravaglione and others 2021 and cubipod.com: bars beside the points
  for _, bar in ipairs{ { "tests: cube of 15 t on a hammer, an edge", 1, {1.5, 2} },
                        { "tests: Cubipod of 16 t, 1.5 times that", 2, {2.25, 3} },
                        { "tests: extreme falls of the Cubipod", 2, {8.5, 9.5} } } do
    series[#series + 1] = { name = bar[1], x = {bar[2] - 0.3, bar[2] - 0.3}, y = bar[3], style = "both" }
  end
end
cdem.write_csv{ file = "heights.csv", columns = columns }
cdem.chart{ file = "heights.png", title = "Heights from which units of " .. math.floor(mass / 1000 + 0.5) .. " t break",
            x_label = "1 cube, 2 Cubipod, 3 dolos, 4 tetrapod, 5 accropode", y_label = "critical height (m)",
            x_range = {0.5, 5.5}, log_y = true, series = series }
for _, attitude in ipairs(attitudes) do
  local cube, cubipod = found["cube_" .. attitude], found["cubipod_" .. attitude]
  figures[#figures + 1] = { name = "cubipod_over_cube_" .. attitude, value = cube and cubipod and cubipod / cube, reference = 1.5,
                            kind = "paper", source = "Scaravaglione and others 2021" }
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
