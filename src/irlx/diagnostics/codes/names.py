"""IRL201 to IRL219: names; IRL260 to IRL263: modules."""

from irlx.diagnostics.codes.code import Code, error, warning

NAMES: tuple[Code, ...] = (
    error("IRL201", "unknown name '{name}'{near}", "declare it in VAR, CONST or a data list"),
    error("IRL202", "'{name}' is declared twice", "remove or rename one of the two"),
    error("IRL203", "MOVE has no parameter '{name}'{near}"),
    error("IRL204", "unknown type '{name}'{near}", "declare it in TYPE before use"),
    warning(
        "IRL205",
        "port '{name}' is not declared",
        "declare it, an output as VAR OUTPUT BOOL: name AT number; irlx fmt does so",
    ),
    error("IRL206", "unknown function '{name}'{near}"),
    error("IRL207", "unknown procedure '{name}'{near}", "declare it with PROCEDURE"),
    error(
        "IRL208",
        "GOTO '{name}' jumps into a structured statement",
        "put the label on the level of the GOTO or outside of it",
    ),
    error("IRL209", "'{name}' is no function", "an element of an array is taken with [ ]"),
    warning("IRL210", "no GOTO uses the label '{name}'"),
    error("IRL211", "'{name}' is {kind} and cannot be set"),
    error("IRL212", "MOVE parameter '{name}' is given twice"),
    warning("IRL213", "'{name}' hides a name of the program", "rename the local one if that is not meant"),
    error("IRL214", "the record has two fields '{name}'"),
    error("IRL215", "unknown label '{name}'{near}", "write 'name:' before the statement to jump to"),
    error("IRL216", "'{name}' is a system variable: assign to it instead of declaring it"),
    error("IRL217", "EXIT outside of a loop", "EXIT leaves FOR, WHILE or REPEAT; HALT ends the program"),
    error("IRL218", "no module '{module}'{near}", "a module NAME is the file NAME.irl beside the program"),
    error(
        "IRL260",
        "module '{module}' is imported in a circle: {files}",
        "move what both need into a module of its own",
    ),
    error("IRL261", "the module '{module}' cannot be read from {path}: {cause}"),
    error(
        "IRL262",
        "expected a module, found {found}",
        "a module begins with MODULE name; and ends with ENDMODULE",
    ),
    warning(
        "IRL263",
        "the module is called '{found}' here and '{name}' where it is imported",
        "write MODULE {name};",
    ),
    error("IRL219", "{file} does not export '{name}'{near}", "add it to an EXPORT of the module"),
)
