-- The height from which each unit breaks, by shape and attitude: case.lua many times, one table and one chart.
--
--   ./cdem run examples/drop_test/study.lua [--set fineness=6] [--set mass=5000]
local cdem = require "cdem"

local mass = cdem.parameter{ name = "mass", default = 16000.0, range = {1, 1e6}, unit = "kg" }
local fineness = cdem.parameter{ name = "fineness", default = 3.0, range = {2, 30}, doc = "Dn over edge of the tets" }
local bisections = cdem.parameter{ name = "bisections", default = 2, range = {0, 20} }
local only = cdem.parameter{ name = "attitude", default = "all", choices = {"all", "flat", "edge", "corner"} }

local shapes, attitudes = {"cube", "cubipod", "dolos", "tetrapod", "accropode"}, {"flat", "edge", "corner"}
if only ~= "all" then attitudes = {only} end
local sets = {}
for _, shape in ipairs(shapes) do
  for _, attitude in ipairs(attitudes) do
    sets[#sets + 1] = { shape = shape, attitude = attitude, mass = mass, fineness = fineness, bisections = bisections,
                        pictures = false }
  end
end
local results = cdem.sweep{ script = "case.lua", set = sets }
local names, heights, series, figures = {}, {}, {}, {}
for a, attitude in ipairs(attitudes) do series[a] = { name = attitude, x = {}, y = {}, style = "both" } end
for i, result in ipairs(results) do
  local s, a = (i - 1) // #attitudes + 1, (i - 1) % #attitudes + 1
  local height = result.figures and result.figures.critical_height_m or 0
  names[i], heights[i] = shapes[s] .. " " .. attitudes[a], height
  series[a].x[s], series[a].y[s] = s, height
  figures[i] = { name = shapes[s] .. "_" .. attitudes[a] .. "_m", value = height, unit = "m" }
end
-- 15 t cube and 16 t Cubipod on real floors (Scaravaglione and others 2021).
series[#series + 1] = { name = "cube of 15 t, tests: 1.5 to 2 m", x = {1, 1}, y = {1.5, 2} }
local columns = { { name = "shape", values = series[1].x } }
for a, attitude in ipairs(attitudes) do columns[a + 1] = { name = attitude .. "_m", values = series[a].y } end
cdem.write_csv{ file = "heights.csv", columns = columns }
cdem.chart{ file = "heights.png", title = "Heights from which units of " .. math.floor(mass / 1000 + 0.5) .. " t break",
            x_label = "1 cube, 2 Cubipod, 3 dolos, 4 tetrapod, 5 accropode", y_label = "critical height (m)", series = series }
local function ratio(attitude)
  local cube, cubipod
  for i, name in ipairs(names) do
    if name == "cube " .. attitude then cube = heights[i] end
    if name == "cubipod " .. attitude then cubipod = heights[i] end
  end
  return cube and cube > 0 and cubipod / cube or nil
end
figures[#figures + 1] = { name = "cubipod_over_cube_flat", value = ratio("flat"), reference = 1.5, kind = "paper",
                          source = "Scaravaglione and others 2021" }
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
