"""The commonest mistakes of beginners: where each can be made in a sound program, and what has to be said.

Every mistake changes one line and leaves the number of lines as it is.
"""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Mistake:
    """`pattern` finds lines where it can be made, `replacement` makes it; `code` and `says` are the answer.

    `says` are words that message or help must hold: what is wrong, and what to do. `balance` is the END word
    that it leaves out (``-ENDIF``) or adds (``+ENDIF``).
    """

    name: str
    pattern: str
    replacement: str
    code: str
    says: tuple[str, ...]
    balance: str = ""

    def places(self, lines):
        """Indices of the lines where it can be made."""
        return [index for index, line in enumerate(lines) if re.search(self.pattern, line)]

    def goes_with(self, other):
        """Whether both may be made in one program.

        One END word too few and the same too many elsewhere make a text whose words fit each other. A
        keyword is told once, wherever it is used as a name.
        """
        cancelled = self.balance and self.balance[1:] == other.balance[1:] and self.balance != other.balance
        return not cancelled and not (self is other and "IRL106" in self.code)

    def made_in(self, line):
        """The line with the mistake."""
        made = re.sub(self.pattern, self.replacement, line, count=1)
        assert made != line, (self.name, line)
        assert "\n" not in made
        return made


MISTAKES = (
    Mistake("IF without THEN", r"^( *IF .*) THEN$", r"\1", "IRL104", ("THEN", "IF condition THEN")),
    Mistake("ELSIF without THEN", r"^( *ELSIF .*) THEN$", r"\1", "IRL104", ("THEN", "ELSIF")),
    Mistake("WHILE without DO", r"^( *WHILE .*) DO$", r"\1", "IRL104", ("DO", "WHILE condition DO")),
    Mistake("FOR without DO", r"^( *FOR .*) DO$", r"\1", "IRL120", ("missing DO",)),
    Mistake("CASE without OF", r"^( *CASE \w+) OF$", r"\1", "IRL120", ("missing OF",)),
    Mistake("= for :=", r"^( *[\w.]+(?:\[[^]]*\])?) := ", r"\1 = ", "IRL105", ("':='", "sets a value")),
    Mistake("FOR with =", r"^( *FOR \w) := ", r"\1 = ", "IRL105", ("':='",)),
    Mistake("unclosed comment", r"^( *\{.*)\}$", r"\1", "IRL110 IRL126", ("comment", "close")),
    Mistake("unclosed comment of the other kind", r"^( *\(\*.*)\*\)$", r"\1", "IRL110 IRL126", ("comment",)),
    Mistake("unclosed string", r"^(.*'[^']*)'(.*)$", r"\1\2", "IRL111", ("without closing '",)),
    Mistake(
        "keyword as a name", r"^( *)(speed|angle) := ", r"\1path := ", "IRL106", ("PATH", "another name")
    ),
    Mistake("keyword as a value", r":= count \+ 1;", ":= step * exit;", "IRL106", ("EXIT", "another name")),
    Mistake("missing ENDIF", r"^ *ENDIF;$", "", "IRL107", ("missing ENDIF", "IF of line"), "-ENDIF"),
    Mistake(
        "missing ENDCASE", r"^ *ENDCASE;$", "", "IRL107", ("missing ENDCASE", "CASE of line"), "-ENDCASE"
    ),
    Mistake("missing ENDFOR", r"^ *ENDFOR;$", "", "IRL107", ("missing ENDFOR", "FOR of line"), "-ENDFOR"),
    Mistake(
        "missing ENDWHILE", r"^ *ENDWHILE;$", "", "IRL107", ("missing ENDWHILE", "WHILE of line"), "-ENDWHILE"
    ),
    Mistake("missing UNTIL", r"^ *UNTIL .*;$", "", "IRL107", ("missing UNTIL", "REPEAT of line")),
    Mistake("missing ENDPROC", r"^ENDPROC;$", "", "IRL107", ("missing ENDPROC", "PROCEDURE of line")),
    Mistake("missing ENDFCT", r"^ENDFCT;$", "", "IRL107", ("missing ENDFCT", "FUNCTION of line")),
    Mistake("missing ENDRECORD", r"^( *)ENDRECORD = ", r"\1= ", "IRL107", ("missing ENDRECORD",)),
    Mistake("missing ENDPROGRAM", r"^ENDPROGRAM;$", "", "IRL107", ("missing ENDPROGRAM",)),
    Mistake(
        "missing semicolon", r"^( +[\w.]+(?:\[[^]]*\])? := .*);$", r"\1", "IRL102 IRL103", ("';' after",)
    ),
    Mistake("MOVE without semicolon", r"^( +MOVE .*);$", r"\1", "IRL102 IRL103", ("';' after the MOVE",)),
    Mistake(
        "RETURN without semicolon", r"^( +RETURN .*);$", r"\1", "IRL102 IRL103", ("';' after the RETURN",)
    ),
    Mistake("END without semicolon", r"^( +END\w+);$", r"\1", "IRL102 IRL103", ("';' after the END",)),
    Mistake(
        "declaration without semicolon",
        r"^(  [A-Z]\w+: \w+.*);$",
        r"\1",
        "IRL102 IRL103",
        ("';' after the d",),
    ),
    Mistake("comma for semicolon", r"^( +[\w.]+ := .*);$", r"\1,", "IRL122 IRL114", ("','", "';'")),
    Mistake("MOVE with comma for semicolon", r"^( +MOVE [^:]*);$", r"\1,", "IRL122", ("','", "';'")),
    Mistake("missing )", r"^( +\w+ := .*\([^()]*)\);$", r"\1;", "IRL120", ("missing ')'",)),
    Mistake("one ) too many", r"^( +\w+ := .*\));$", r"\1);", "IRL108", ("')' without '('",)),
    Mistake("missing ]", r"^( +MOVE LIN rack\[\d+)\]", r"\1", "IRL120", ("missing ']'",)),
    Mistake(
        "one ENDIF too many",
        r"^( *)ENDWHILE;$",
        r"\1ENDWHILE; ENDIF;",
        "IRL108",
        ("ENDIF without IF",),
        "+ENDIF",
    ),
    Mistake(
        "one ENDFOR too many",
        r"^( *)ENDIF;$",
        r"\1ENDIF; ENDFOR;",
        "IRL108",
        ("ENDFOR without FOR",),
        "+ENDFOR",
    ),
    Mistake("another END", r"^( *)ENDWHILE;$", r"\1ENDFOR;", "IRL107", ("missing ENDWHILE",), "+ENDFOR"),
    Mistake("missing BEGIN", r"^BEGIN$", "", "IRL120", ("missing BEGIN",)),
    Mistake("typographic quotes", r"'([^']*)'", r"“\1”", "IRL123", ("quote", "'")),
    Mistake("one kind of quote before, one behind", r"'([^']*)'", r"'\1" + '"', "IRL111", ("closing",)),
    Mistake("declaration without :", r"^(  [A-Z]\w+): ", r"\1 ", "IRL120", ("missing ':'",)),
    Mistake("WHEN without :", r"^( *WHEN .*):$", r"\1", "IRL120", ("missing ':'",)),
    Mistake("ELSE IF for ELSIF", r"^( *)ELSIF ", r"\1ELSE IF ", "IRL125", ("ELSE IF", "ELSIF"), "-ENDIF"),
    Mistake("no ; before ELSE", r"^(    message := 'last part');$", r"\1", "IRL102", ("';' after",)),
    Mistake("END. for ENDPROGRAM", r"^ENDPROGRAM;$", "END.", "IRL121", ("END", "ENDPROGRAM")),
    Mistake("ENDPROG for ENDPROGRAM", r"^ENDPROGRAM;$", "ENDPROG;", "IRL121", ("ENDPROG", "ENDPROGRAM")),
    Mistake("END for ENDFOR", r"^( *)ENDFOR;$", r"\1END;", "IRL121", ("END", "ENDFOR")),
    Mistake("END IF for ENDIF", r"^( *)ENDIF;$", r"\1END IF;", "IRL121", ("END", "ENDIF")),
    Mistake("MOV for MOVE", r"^( *)MOVE ", r"\1MOV ", "IRL121", ("MOV", "MOVE")),
    Mistake("LN for LIN", r"MOVE LIN ", r"MOVE LN ", "IRL121", ("LN", "LIN")),
    Mistake("CYCLICSTRAT", r"CYCLICSTART", "CYCLICSTRAT", "IRL121", ("CYCLICSTRAT", "CYCLICSTART")),
    Mistake("FREEZSTART", r"FREEZESTART", "FREEZSTART", "IRL121", ("FREEZSTART", "FREEZESTART")),
    Mistake("WHLIE for WHILE", r"^( *)WHILE ", r"\1WHLIE ", "IRL121", ("WHLIE", "WHILE")),
    Mistake("ELS for ELSE", r"^( *)ELSE$", r"\1ELS", "IRL121", ("ELS", "ELSE")),
    Mistake("THNE for THEN", r"THEN$", "THNE", "IRL121", ("THNE", "THEN")),
    Mistake("ENDFI for ENDIF", r"ENDIF;$", "ENDFI;", "IRL121", ("ENDFI", "ENDIF")),
    Mistake("parameter without :=", r"SPEED := (\d+\.)", r"SPEED \1", "IRL120", ("missing ':='",)),
    Mistake("parameter with =", r"SPEED := (\d+\.)", r"SPEED = \1", "IRL105", ("':='",)),
    Mistake(
        "decimal comma", r"^( *\w+ := )\d+(\.\d*)?( \+ \w+)?;$", r"\g<1>1,5;", "IRL124", ("1.5", "point")
    ),
    Mistake("decimal comma in a MOVE", r"SPEED := \d+\.;", "SPEED := 0,5;", "IRL124", ("0.5", "point")),
    Mistake("// comment", r"^(  \w.*;)$", r"\1 // don't know", "IRL123", ("'//'", "{ .. }")),
    Mistake("== for =", r"^( *(?:IF|ELSIF) .*) = ", r"\1 == ", "IRL123", ("'=='", "write =")),
    Mistake("!= for <>", r"^( *(?:IF|ELSIF) .*) [=>] ", r"\1 != ", "IRL123", ("'!='", "write <>")),
    Mistake("WAIT without SEC", r"^( *WAIT [\d.]+) SEC;$", r"\1;", "IRL120", ("missing SEC",)),
)
