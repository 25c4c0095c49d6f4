# Draws response.png: gnuplot response.gp
if (!exists('ending')) ending = ''
if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {
    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'
} else {
    set terminal png size 1100,700
}
set encoding utf8
set datafile missing 'nan'
set grid linetype 1 linecolor '#c8c8c8' linewidth 1
set border linecolor '#404040'
set key outside right top Left reverse noenhanced
set tics nomirror
set format y '%g'
set style line 1 linecolor '#0072B2' linewidth 2 pointtype 7 pointsize 2.2
set output 'response.png'.ending
set title 'What the responses cost'
set key outside top center horizontal
set ylabel 'cost of a particle-step over the exact response'
set style fill solid 0.85 noborder
set grid noxtics
set boxwidth 0.5
set yrange [0:*]
set offsets 0,0,graph 0.05,0
set xtics ('exact' 0, 'rollback' 1, 'project' 2, 'penalty' 3) rotate by -30 noenhanced
set xrange [-0.6:3.6]
$numbers << EOD
"exact" 1
"rollback" 3.8578
"project" 6.6084
"penalty" 27.0761
EOD
plot $numbers using ($0+(0)):2 with boxes linestyle 1 title 'cost over exact', \
     $numbers using ($0+(0)):2:(sprintf('%.2g',column(2))) with labels offset 0,0.6 font ',10' notitle, \
     1 with lines linecolor '#404040' dashtype 2 notitle
set output
