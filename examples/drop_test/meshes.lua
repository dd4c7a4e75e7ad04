-- Does the height of a drop test converge with the mesh? case.lua for several meshes and fracture energies. The larger the
-- fracture energy, the more faces lie in the process zone.
--
--   ./cdem run examples/drop_test/meshes.lua
--   ./cdem run examples/drop_test/meshes.lua --set attitude=flat --set fracture_energies=100
local cdem = require "cdem"

local shape = cdem.parameter{ name = "shape", default = "cube", choices = {"cube", "cubipod", "dolos", "tetrapod", "accropode"} }
local attitude = cdem.parameter{ name = "attitude", default = "edge", choices = {"flat", "edge", "corner"} }
local finenesses = cdem.parameter{ name = "finenesses", default = {3.0, 5.0, 8.0}, range = {2, 30},
                                   doc = "Dn over edge of the tets" }
local energies = cdem.parameter{ name = "fracture_energies", default = {100.0, 300.0, 1000.0}, range = {1, 1e5},
                                 unit = "J/m2" }
local bisections = cdem.parameter{ name = "bisections", default = 3, range = {0, 20} }

local sets = {}
for _, energy in ipairs(energies) do
  for _, fineness in ipairs(finenesses) do
    sets[#sets + 1] = { shape = shape, attitude = attitude, fracture_energy = energy, fineness = fineness,
                        bisections = bisections, low = 0.4 * (energy / 100) ^ 0.7, pictures = false }
  end
end
local results, series, figures = cdem.sweep{ script = "case.lua", set = sets }, {}, {}
for i, set in ipairs(sets) do
  local found, s = results[i].figures or {}, (i - 1) // #finenesses + 1
  series[s] = series[s] or { name = string.format("G_I %g J/m2", set.fracture_energy), x = {}, y = {}, style = "both" }
  table.insert(series[s].x, found.faces_in_process_zone or 0 / 0)
  table.insert(series[s].y, found.critical_height_m or 0 / 0)
  local at = string.format("_g_%g_fineness_%g", set.fracture_energy, set.fineness)
  figures[#figures + 1] = { name = "height" .. at, value = found.critical_height_m, unit = "m" }
  figures[#figures + 1] = { name = "faces_in_zone" .. at, value = found.faces_in_process_zone }
end
series[#series + 1] = { name = "three resolve the zone", x = {3, 3}, y = {0.1, 10}, style = "dashed" }
cdem.chart{ file = "meshes.png", title = string.format("%s, %s: the height over the mesh", shape, attitude),
            x_label = "faces in the process zone", y_label = "critical height (m)",
            log_x = true, log_y = true, y_range = {0.1, 10}, series = series }
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
