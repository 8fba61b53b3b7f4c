"""Subtitles as annotation: SubRip (.srt) and WebVTT (.vtt), a cue an interval.

Speakers of WebVTT are tiers: `<v Ann>`, or the class where the voice has no name (`<v.ann>`). In
SubRip a speaker may stand before a colon, which is a declared choice. Source of WebVTT: W3C,
"WebVTT: The Web Video Text Tracks Format", sections 4 and 6.
"""

from __future__ import annotations

import html
import re
from dataclasses import dataclass
from pathlib import Path

from signkin.annotation import Annotation, TierWish, tier_key
from signkin.errors import SignkinError
from signkin.io.collecting import Collected, TierName, choose_tiers
from signkin.io.registry import annotation_reader
from signkin.io.text_rows import TimeFormat, read_text

_ARROW = re.compile(r"\s*(\S+)\s*-->\s*(\S+)(?:\s.*)?")
_VOICE = re.compile(r"<v(?P<classes>(?:\.[^\s<>.]+)*)(?:\s+(?P<name>[^<>]*))?>")
_SRT_MARKUP = re.compile(r"</?(?:i|b|u|font)(?:\s[^<>]*)?>|\{\\[^{}]*\}", re.IGNORECASE)
_VTT_MARKUP = re.compile(r"<[^<>]*>")
_SPEAKER = re.compile(r"\s*([^:\n]{1,40}):\s*(.*)", re.DOTALL)
_MAP = re.compile(r"X-TIMESTAMP-MAP=.*")
_NOT_CUES = ("NOTE", "STYLE", "REGION")
_TIMES = TimeFormat("timecode", None, None)


@dataclass(frozen=True)
class _Cue:
    line: int
    start_s: float
    end_s: float
    text: str


@annotation_reader("srt", suffixes=(".srt",))
def read_srt(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    speaker_before_colon: bool = False,
    encoding: str | None = None,
) -> Annotation:
    """Read the cues of a SubRip file, on the one tier asked for.

    speaker_before_colon: `ANN: text` is a cue of the tier ANN.
    """
    spoken = []
    for cue in _cues(read_text(path, encoding), vtt=False):
        text = _SRT_MARKUP.sub("", cue.text).strip()
        found = _SPEAKER.fullmatch(text) if speaker_before_colon else None
        spoken.append((cue, found[1].strip(), found[2].strip()) if found else (cue, "", text))
    return _annotation(path, name, tiers, spoken)


@annotation_reader("vtt", suffixes=(".vtt",))
def read_vtt(
    path: Path,
    *,
    tiers: tuple[TierWish, ...] | None = None,
    name: str | None = None,
    part: str | None = None,
    encoding: str | None = None,
    timestamp_map: str | None = None,
) -> Annotation:
    """Read the cues of a WebVTT file; speakers are tiers, else the one tier asked for.

    timestamp_map: `ignore`, where the header's X-TIMESTAMP-MAP of a stream moves the clock.
    """
    text = read_text(path, encoding)
    _check_map(text, timestamp_map)
    spoken = []
    for cue in _cues(text, vtt=True):
        voices = list(_VOICE.finditer(cue.text))
        if not voices:
            spoken.append((cue, "", _plain(cue.text)))
        for i, voice in enumerate(voices):
            end = voices[i + 1].start() if i + 1 < len(voices) else len(cue.text)
            named = html.unescape(voice["name"] or "").strip()
            speaker = named or voice["classes"].removeprefix(".").replace(".", " ")
            spoken.append((cue, speaker, _plain(cue.text[voice.end() : end])))
    return _annotation(path, name, tiers, spoken)


def _plain(text: str) -> str:
    return html.unescape(_VTT_MARKUP.sub("", text)).strip()


def _annotation(
    path: Path,
    name: str | None,
    tiers: tuple[TierWish, ...] | None,
    spoken: list[tuple[_Cue, str, str]],
) -> Annotation:
    """Return the cues by speaker; those without one stand on the tier asked for, else `sign`."""
    speakers = list(dict.fromkeys(speaker for _, speaker, _ in spoken if speaker))
    other = tier_key(tiers[0]) if tiers and not speakers else "sign"
    known = [TierName(speaker, speaker) for speaker in speakers]
    if any(not speaker for _, speaker, _ in spoken):
        known.append(TierName(other))
    chosen = choose_tiers(tiers, known)
    wanted = {tier for names in chosen.values() for tier in names}
    collected = Collected()
    for cue, speaker, text in spoken:
        tier = speaker or other
        if tier not in wanted:
            continue
        if text:
            collected.add(cue.start_s, cue.end_s, text, tier, f"line {cue.line}")
        else:
            collected.leave_out(tier, f"line {cue.line}", "a cue without text")
    return collected.annotation(name or path.stem, tiers, chosen)


def _cues(text: str, vtt: bool) -> list[_Cue]:
    out = []
    for first, block in _blocks(text):
        lines = block
        if vtt and ((first == 1 and lines[0].startswith("WEBVTT")) or _is_no_cue(lines[0])):
            continue
        at = next((i for i, line in enumerate(lines[:2]) if "-->" in line), None)
        if at is None:
            raise SignkinError(
                f"found {lines[0][:40]!r}",
                place=f"line {first}",
                expected="a cue: its number, its times (00:00:01,000 --> 00:00:02,000), its text",
            )
        line = first + at
        times = _ARROW.fullmatch(lines[at])
        if times is None:
            raise SignkinError(
                f"found {lines[at][:40]!r}", place=f"line {line}", expected="start --> end"
            )
        start, end = (_TIMES.seconds(time, f"line {line}") for time in times.groups())
        for later, inner in enumerate(lines[at + 1 :], start=line + 1):
            if "-->" in inner:
                raise SignkinError(
                    "another cue starts inside one",
                    place=f"line {later}",
                    expected="an empty line between cues",
                )
        out.append(_Cue(line, start, end, "\n".join(lines[at + 1 :])))
    return out


def _check_map(text: str, declared: str | None) -> None:
    """Refuse a header that moves the clock of the cues (HTTP Live Streaming, section 3.5)."""
    found = _MAP.search(text.partition("\n\n")[0])
    if found is None or declared == "ignore":
        return
    line = text.count("\n", 0, found.start()) + 1
    raise SignkinError(
        f"{found.group()[:60]!r}, by which cues count in the clock of a stream",
        place=f"line {line}",
        expected="times that count from the recording's start",
        todo="Declare options: {timestamp_map: ignore}, and clock_offset_s where they are shifted.",
    )


def _is_no_cue(line: str) -> bool:
    return any(line == word or line.startswith((f"{word} ", f"{word}\t")) for word in _NOT_CUES)


def _blocks(text: str) -> list[tuple[int, list[str]]]:
    """Return stretches of lines between empty ones, with the number of their first line."""
    out: list[tuple[int, list[str]]] = []
    inside = False
    for number, line in enumerate(text.split("\n"), start=1):
        if not line.strip():
            inside = False
        elif inside:
            out[-1][1].append(line)
        else:
            out.append((number, [line]))
            inside = True
    return out
