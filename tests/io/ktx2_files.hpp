// Textures of Basis Universal in base64, and their pixels by its transcoder (1.16.4, to RGBA at 8 bits). The ETC1S texture is what its
// encoder made of a board of squares with a slope of alpha and a plain corner.
#pragma once

namespace halflit::test {

/// 22 x 18 pixels, with a slice of 30 bytes of colour, then one of alpha: 39 colours, 40 patterns.
inline constexpr const char* kEtc1sGlobals =
    "JwAoAIAAAACWAAAARAAAAAAAAAAAAAAAAAAAAB4AAAAeAAAAIQAAACBAJAABIAKi6Jtt9f2YHFwo8gG8ARAAQBBWOpNBvpELAgEeAQgAEBDTmuKxvFjLCQIQAQAA"
    "AEAIFA/OTEkiM0dSSVpVJ2m21d2zjZkNwGxbUiU9ySc5AB39JaJtl6PhcZo7jVAf7h8771dafeiMnHm1Cq8brMfhXvv7Nc8BAAAAMAaeegyCQBj/3Xd/ZCduTKYF"
    "2Mg8gsWTqnMEZDPbTPAGPILBmS8YlEx07gtgZfX/z0wU3ILgmOd5UfQ9MAwXAJXW2nvvAfzf1o5bY8z60zSPJzDPwDgCSQKJzf0Hx45I1IsDTwjBUrT86jq9Y2Yi"
    "IimlPJdlmUbRSSlFgLx+awW1itXkItkiyzLnnBFC2MraMF3uTSwYAMGbgAEAAEERCGMW4zsq8PHIOAHmSAwAEBAAwHACGhGFZzdGC1gDOQBD0mek1SekR4gYDEaj"
    "gZ0AYAIAAAAAAAABBAA=";

/// Its two slices.
inline constexpr const char* kEtc1sLevel = "DM9AIacmq3iJHb2bv8x6lRmkXLLcCDA8aFILsOAP7OPeR11VqxTrsEmd5tg422Y5ovgfOU99C9A8KC+XmApD";

/// Its pixels.
inline constexpr const char* kEtc1sPixels =
    "xSkp/8UpKf/FKSn/xSkp/zsAAA7GSiEOxkohOMZKITiReCVakXglWndeC1p3XgtaRYcLWkWHC1pFhwtafL5CWtm4CyfZuAsn48IVAO/OIQAW3A4AIOYYAMUpKf/F"
    "KSn/xSkp/8UpKf87AAAOxkohOMZKIVzGSiFckXgld5F4JXd3Xgt3d14Ld0WHC3dFhwt3RYcLd3y+QlrZuAtL48IVJ+PCFSfvziEAFtwOACDmGADFKSn/xSkp/8Up"
    "Kf/FKSn/OwAAOMZKIVzGSiFcxkohhpF4JZGReCWRd14LkXdeC5FFhwuRRYcLkUWHC5F8vkJ32bgLdePCFUvjwhVL784hJxrgEgAg5hgAxSkp/8UpKf/FKSn/xSkp"
    "/zsAAFzGSiFcxkohhsZKIYaReCWukXglrndeC653XguuRYcLrkWHC65FhwuufL5Ckdm4C3XjwhV148IVS+/OISca4BIRIOYYAMUpKf/FKSn/xSkp/8UpKf9BGChy"
    "eE9fj3hPX4+VbHypkXglua6VQs13XgvNkXglzXJqKM1yaijNj4dFuamhX7ls32yZbN9sf2zfbGJs32xijN4hLozeIQDFKSn/xSkp/8UpKf/FKSn/eE9fcl41RY9e"
    "NUWpXjVFxndeC813XgvfrpVC366VQt+poV/fqaFfzamhX82Ph0W5Nag1tjWoNZlPwk9/T8JPYtX/akvV/2oUxSkp/8UpKf/FKSn/xSkp/3hPX49eNUWpXjVFxl41"
    "RcZ3Xgvfd14L366VQvOulULzqaFf86mhX9+poV/fj4dFzTWoNbY1qDWZT8JPf0/CT2LV/2pL1f9qLsUpKf/FKSn/xSkp/8UpKf94T1+PXjVFqV41RcZeNUXGd14L"
    "33deC/OulULzrpVC86mhX/OpoV/zqaFf34+HRc01qDW2Nag1tk/CT5lPwk9/1f9qS9X/ai7FKSn/xSkp/8UpKf/FKSn/eE9foF41RbReNUXGeE9f2l41ReqVbHz0"
    "lWx8/5VsfP+Nprf/jaa3/42mt+ZpgpPmJaGZzyWhmbJCvraYQr62e7zdzVy83c04xSkp/8UpKf/FKSn/xSkp/3hPX6BeNUW0XjVFxnhPX9peNUXqlWx89JVsfP+V"
    "bHz/jaa3/42mt/+NprfmaYKT5iWhmc9CvrayQr62mEK+tnu83c1cvN3NOMUpKf/FKSn/xSkp/8UpKf9eNUWglWx8tJVsfMaVbHzaeE9f6pVsfPSVbHz/lWx8/z9Y"
    "aX4/WGl+P1hpfj9YaX4AamJ7AGpiewBqYnsAamJ7MVJChjFSQobFKSn/xSkp/8UpKf/FKSn/XjVFoJVsfLSVbHzGlWx82nhPX+qVbHzqlWx89JVsfPQ/WGl+P1hp"
    "fj9YaX4/WGl+AGpiewBqYnsAamJ7AGpiezFSQoYxUkKGxSkp/8UpKf/FKSn/xSkp/141RYeVbHyhlWx8vpVsfL6ReMrjkXjK43desON3XrDjEVudgBFbnYARW52A"
    "EVudgBFbnYARW52AEVudgBFbnYARW52AEVudgMUpKf/FKSn/xSkp/8UpKf9eNUWHlWx8oZVsfKGVbHy+kXjKz5F4ys93XrDjd16w4xFbnYARW52AEVudgBFbnYAR"
    "W52AEVudgBFbnYARW52AEVudgBFbnYDFKSn/xSkp/8UpKf/FKSn/XjVFapVsfIeVbHyhlWx8oZF4yr2ReMq9d16wz3desM8RW52AEVudgBFbnYARW52AEVudgBFb"
    "nYARW52AEVudgBFbnYARW52AxSkp/8UpKf/FKSn/xSkp/5VsfGpeNUVqeE9fh3hPX6FaQZOpd16wqZF4yr2ulee9EVudgBFbnYARW52AEVudgBFbnYARW52AEVud"
    "gBFbnYARW52AEVudgMUpKf/FKSn/xSkp/8UpKf9PNvQ9Tzb0V0829HRPNvR0WkL/iVpC/5Wji/+Vo4v/lRFbnYARW52AEVudgBFbnYARW52AEVudgBFbnYARW52A"
    "EVudgBFbnYDFKSn/xSkp/8UpKf/FKSn/Tzb0IE829D1PNvRXTzb0V1pC/3NaQv9zo4v/f6OL/38RW52AEVudgBFbnYARW52AEVudgBFbnYARW52AEVudgBFbnYAR"
    "W52A";

/// 19 blocks, one of each mode from 0 to 18, whose other bits are random.
inline constexpr const char* kUastcBlocks =
    "MWUJOuVP016n91j2bDYYYPU4VyCmF3Ax2uFutLAQNQu9sw4V0iQII9RKWD8QAK/PQxV7NSnylGZsfVGkcVTBB/NhJn20fAB0qF32Y4Ivt35LCjYxOAa45cEKndSQ"
    "SBZn28XtFtB6L3wUavM7qGpPwmcm3gQiV3+zQt9KRLpfKoXXO215gK/t5nmqQekxFgthT0PbOU54HR3q47epVqojQoqn2f0ajHHQcJQmENMX6WLA08Oeozlc1AWE"
    "kGBDH5QbpgQtqeyk3A5X6aNWZ+UCPB8T+bHEsQcWHnBhf06yROetI1SnDLxNhGmCwOYGATo1BZTflAHT8s6OJ2MkMsZRmxXIevJt0SqKSm0w8oVLlwmldaqzfGqg"
    "MRLy8CX99S/yaXE93PbWNpTEqc10Wuibug==";

/// Their pixels, 76 x 4.
inline constexpr const char* kUastcPixels =
    "o594/4lvlv+VhYn/eE6r/wK9i/8xgNH/Eami/wK9i/9NEaH/kpIf/3qLHf+qmSL/iy5F/2NljP8ui7r/Y2WM/yKZOv/YOmH/2Dph/4Ronv8TY1v/Qm9B/2N4L/8T"
    "Y1v/uKxw/7iscP+hzsv/oc6c/9Jh+f/XVL//0mH5/9dUv//eacsD3mnLA95pywPeacsDW8fNoFvHzaBbx82gjV/GSZMwTExSS5ZCbUB3RjxUsD5BTN3aQXHP3z1x"
    "z985cc/fgLndJLnBnFaSvMg0pb6zRBIeeIXHWMCFEh54/cdYwP3K25gIwEQmbMeqcyjARCZsExMTsCUlJYo/Pz9WExMTsEBAQIdSUlKMUlJSjBsbG3y1tbUD5eXl"
    "MIODgwPl5eUwdclr/z63a/9Uvmv/asZr/5B7j/+ckYH/mIuF/3hOq/8hlLr/MYDR/yGUuv8xgNH/YRGN/3URef+IEWb/YoMa/3R0Lv8ui7r/nD1c/9EXLv8NbkH/"
    "Ipk6/9g6Yf/YOmH/MmtK/4OAHv9UdDf/VHQ3/4vvcP+L7/f/i+/L/4vvcP/bR4H/20eB/986R/9oaP//3mnLA95pywPeacsD3mnLA3fM7u5bx82gjV/GSY1fxklb"
    "R4xDgTdgSZMwTEyKM1ZKQXHP3zlM3dpBcc/fPSXs1cvEh2bdx3J2gLndJKW+s0QSHniFx1jAhRIeeP0SHniFytuYCMrbmAjEdktLytuYCDAwMHMKCgrCExMTsA4O"
    "DrlAQECHQEBAhy0tLYEtLS2Bg4ODjbW1tQODg4ONU1NTYNfqa/+r22v/tt9r/8fla/+CYZ//mIuF/5iLhf+jn3j/IZS6/xGpov8CvYv/Eami/0QRqv9rEYP/RBGq"
    "/0QRqv+LLkX/XKN0/4qEfP+KhHz/TvIt/07yLf8imTr/vUl1/zJrSv9Cb0H/E2Nb/yJnUv/Oi8v/oc7L/6HOy/+hzpz/hCD//4Qg//+EIP//ezf//95pywPeacsD"
    "3mnLA95pywMiu4gAW8fNoFURu0SNX8ZJeDtqSBZk2zhSS5ZCijNWSkEA+s89cc/fNgD6z0FM3drLxIdmucGcVqW+s0SAud0kx1jA/RIeeP0SHniFx1jAhcrbmAjK"
    "25gIytuYCMeqcygKCgrCMDAwcwoKCsITExOwGxsbfC0tLYFSUlKMGxsbfOXl5TCDg4NgU1NTjVNTU2Cr22v/ptpr/7bfa/+W1Gv/kHuP/6qscP+tsmz/mIuF/zGA"
    "0f8hlLr/Ar2L/wK9i/9EEar/axGD/4gRZv9XEZf/g0U9/4qEfP9co3T/XKN0/zjHM/9O8i3/OMcz/yKZOv8iZ1L/MmtK/zJrSv9zfCb/i+/3/86LnP+hznD/zov3"
    "/2ho//9xUP//cVD//3FQ///eacsD3mnLA95pywPeacsDd8zu7o1fxklVEbtEx7HSTzxUsD4NaOU3gTdgSVtHjEM9cc/fOUzd2jkA+s9BTN3abrbyFG628hTvyV2G"
    "gLndJBIeeIXHWMCFx1jA/cdYwIXARCZsx6pzKMR2S0vEdktLR0dHRCwsLHw1NTVqQ0NDTVtbW4qXl5eaW1tbiltbW4qDg4ONU1NTjbW1tTDl5eUw4u5r/4DNa/9v"
    "x2v/vOFr/w==";

}  // namespace halflit::test
