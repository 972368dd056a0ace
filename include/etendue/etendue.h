// All of the library: load a scene, render it, read its pixels, write it.
#pragma once

#include <etendue/error.h>
#include <etendue/message.h>
#include <etendue/picture.h>
#include <etendue/render.h>
#include <etendue/scene.h>
