-- pairs in a fixed order: numbers ascending, then names in alphabetical order, then the rest. Lua's own order changes
-- from run to run, and with it the order in which a script would build its bodies.
local raw_pairs = pairs
local sort, type, getmetatable, tostring = table.sort, type, getmetatable, tostring

local function before(a, b)
  local type_a, type_b = type(a), type(b)
  if type_a ~= type_b then
    if type_a == "number" or type_b == "number" then return type_a == "number" end
    if type_a == "string" or type_b == "string" then return type_a == "string" end
    return type_a < type_b
  end
  if type_a == "number" or type_a == "string" then return a < b end
  return tostring(a) < tostring(b)
end

function _ENV.pairs(t)
  local meta = getmetatable(t)
  if type(t) ~= "table" or (type(meta) == "table" and meta.__pairs) then return raw_pairs(t) end
  local keys, n = {}, 0
  for key in raw_pairs(t) do
    n = n + 1
    keys[n] = key
  end
  sort(keys, before)
  local i = 0
  return function()
    while i < n do
      i = i + 1
      local value = t[keys[i]]
      if value ~= nil then return keys[i], value end
    end
  end, t, nil
end
