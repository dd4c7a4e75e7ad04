-- Every array of the files that a run writes, every column of its tables and every key of its report stands in
-- docs/output-files.md, and the page names no field that no file has.
local cdem = require "cdem"
local pages = require "pages"

local page = pages.read(pages.root .. "/docs/output-files.md")
local written, count = {}, 0
local function named(name, file)
  count = count + 1
  written[name] = true
  if not page:find("`" .. name .. "`", 1, true) then
    pages.complain("docs/output-files.md", nil, file .. " has " .. name .. ", which is not described")
  end
end
local function read(name) return pages.read(pages.scratch .. "/files/" .. name) end
local function arrays(name)
  for array in read(name):match("^.-</Piece>"):gmatch 'Name="([%w_]+)"' do
    if not (array == "Points" or array == "connectivity" or array == "offsets" or array == "types") then named(array, name) end
  end
end
local function columns(name)
  for column in read(name):match("^[^\n]*"):gmatch "[^,\r]+" do named(column, name) end
end

-- Blocks with a joint set and a bolt that break, and a mesh with a named face.
local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = 2500 }
local joint = cdem.mohr_coulomb{ cohesion = 2e6, friction_angle = 30, tensile_strength = 1e6 }
local shape = cdem.cut_by_joints{ shape = cdem.box{ size = {1, 1, 1} },
                                  sets = { { name = "bedding", dip = 0, dip_direction = 0, spacing = 0.4 } } }
local model = cdem.model{ bodies = { { name = "rock", shape = shape, material = rock, joint = joint } } }
model:fix{ on = "z-" }
model:bolts{ from = {0.5, 0.5, 0.05}, to = {0.5, 0.5, 0.95}, area = 1e-4 }
model:gravity{ vector = {0, 0, -9.81} }
model:relax{ residual = 1e-2 }
model:initial_velocity{ on = cdem.select.box{ min = {0, 0, 0.7}, max = {1, 1, 1} }, velocity = {0, 0, 2} }
model:run{ steps = 200 }
model:flow{ water = cdem.water.uniform{ velocity = {1, 0, 0}, level = 0.5 } }
model:save{ file = "a.vtu" }
model:save_cracks{ file = "cracks.vtp" }
model:save_joints{ file = "joints.vtp" }
model:save_fragments{ file = "fragments.csv" }
model:save_bolts{ file = "bolts.csv" }
local mesh = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1} }
mesh:faces{ side = "z+", name = "top" }
mesh:save{ file = "mesh.vtu" }
cdem.report{ { name = "a", value = 1, unit = "m", reference = 1, kind = "formula", source = "1", tolerance = 0.1 } }

for _, name in ipairs{ "a.vtu", "a_bonds.vtu", "a_contacts.vtu", "a_water.vtu", "cracks.vtp", "joints.vtp" } do arrays(name) end
for array in read("mesh.vtu"):gmatch 'Name="([%w_]+)"' do written[array] = true end
for _, name in ipairs{ "region", "radius_ratio", "min_dihedral", "volume", "on_top" } do
  if not written[name] then pages.complain("tests/docs/files.lua", nil, "mesh.vtu has no " .. name) end
end
columns "history.csv"
columns "bolts.csv"
for column in read("fragments.csv"):match("^[^\n]*"):gmatch "[^,\r]+" do -- x to z are named by their ends
  if not column:match "_y$" then named(column, "fragments.csv") end
end
local report = read "report.json"
for key in report:gmatch '"([%l_]+)":' do
  written[key] = true
  if not page:find("[`%].,]" .. key .. "`") then
    pages.complain("docs/output-files.md", nil, "report.json has " .. key .. ", which is not described")
  end
end

-- Names in the first column of the page's tables of fields are arrays or columns.
for name in page:gmatch "\n| `([%l_]+)`[^|]*| [^|]*|" do
  if not written[name] and not (name == "figures" or name == "case") then
    pages.complain("docs/output-files.md", nil, "no file has a field " .. name)
  end
end
pages.finish(count)
