#include "harness/lua/library.hpp"

namespace whirl::lua {

const char* const kPrelude = R"lua(
local type, getmetatable, raw_tostring, raw_format = type, getmetatable, tostring, string.format
local next, sort, error, select = next, table.sort, error, select
local find, unpack = string.find, table.unpack

local function shown(v)
  local t = type(v)
  if t == "table" or t == "userdata" then
    local meta = getmetatable(v)
    if not (type(meta) == "table" and meta.__tostring) then return t end
  elseif t == "function" or t == "thread" then
    return t
  end
  return raw_tostring(v)
end
tostring = shown

string.format = function(form, ...)
  if type(form) == "string" and find(form, "%%[-+ #0]*%d*%.?%d*p") then
    error("%p prints an address, which differs from run to run", 2)
  end
  local n, given = select("#", ...), {...}
  for i = 1, n do
    local t = type(given[i])
    if t ~= "number" and t ~= "string" and t ~= "boolean" and t ~= "nil" then given[i] = shown(given[i]) end
  end
  return raw_format(form, unpack(given, 1, n))
end

local rank = { number = 1, string = 2, boolean = 3 }
local function before(a, b)
  local ra, rb = rank[type(a)], rank[type(b)]
  if ra ~= rb then return ra < rb end
  if ra == 3 then return not a and b end
  return a < b
end
pairs = function(t)
  if type(t) ~= "table" then error("pairs wants a table, not a " .. type(t), 2) end
  local keys = {}
  for k in next, t do
    if not rank[type(k)] then error("pairs: a " .. type(k) .. " as key has no order", 2) end
    keys[#keys + 1] = k
  end
  sort(keys, before)
  local i = 0
  return function()
    local k
    repeat i = i + 1; k = keys[i] until k == nil or t[k] ~= nil
    if k ~= nil then return k, t[k] end
  end
end
for _, name in ipairs { "next", "load", "loadfile", "dofile", "collectgarbage", "print", "warn",
                        "rawget", "rawset", "rawequal", "rawlen", "getmetatable", "setmetatable",
                        "xpcall", "_VERSION" } do _G[name] = nil end
math.random, math.randomseed, string.dump = nil, nil, nil
)lua";

}  // namespace whirl::lua
